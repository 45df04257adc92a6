#include "io/formats/voxels/npy_array.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string>

#include "streaming/error.h"

namespace svdag {
namespace {

// The text after `key` in a header, which is a Python dictionary as NumPy writes it.
std::string_view header_value(std::string_view header, std::string_view key, const File& file,
                              uint64_t offset) {
  const size_t at = header.find(key);
  const size_t colon = at == std::string_view::npos ? at : header.find(':', at);
  if (colon == std::string_view::npos)
    fail_input(file.path(), "damaged .npy header: no " + std::string(key), offset);
  header.remove_prefix(colon + 1);
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  return header;
}

std::vector<uint64_t> parse_shape(std::string_view text, const File& file, uint64_t offset) {
  std::vector<uint64_t> shape;
  const auto bad = [&] { fail_input(file.path(), "damaged .npy header: bad shape", offset); };
  if (text.empty() || text[0] != '(') bad();
  unsigned __int128 product = 1;
  for (text.remove_prefix(1); !text.empty() && text[0] != ')';) {
    uint64_t side = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || shape.size() == 8) bad();
    shape.push_back(side);
    product *= side;
    if (product >> 62 != 0) bad();
    text.remove_prefix(size_t(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
  }
  return shape;
}

}  // namespace

NpyArray read_npy_header(const File& file, uint64_t offset, uint64_t end) {
  ByteStream stream(file, offset, end);
  std::array<char, 8> start{};
  if (stream.remaining() < 12) fail_input(file.path(), "is not a .npy array", offset);
  stream.read(std::as_writable_bytes(std::span(start)));
  if (std::string_view(start.data(), 6) != kNpyMagic || start[6] < 1 || start[6] > 3)
    fail_input(file.path(), "is not a .npy array", offset);
  uint32_t length = 0;
  stream.read(std::as_writable_bytes(std::span(&length, 1)).first(start[6] == 1 ? 2 : 4));
  if (length > 65536 || length > stream.remaining())
    fail_input(file.path(), "damaged .npy header: impossible length", offset);
  std::string header(length, '\0');
  stream.read(std::as_writable_bytes(std::span(header)));
  NpyArray array;
  const std::string_view type = header_value(header, "'descr'", file, offset);
  if (type.size() < 5 || std::string_view("<>|").find(type[1]) == std::string_view::npos)
    return array;
  uint32_t size = 0;
  const char* const type_end = type.data() + type.size();
  const auto [size_end, error] = std::from_chars(type.data() + 3, type_end, size);
  const bool is_known = type[2] == 'U' || type[2] == 'S' || size <= 8;
  if (error != std::errc() || size == 0 || size_end == type_end || *size_end != type[0] ||
      !is_known)
    return array;
  array.big_endian = type[1] == '>' && size > 1;
  if (array.big_endian && type[2] == 'U') return array;
  array.kind = type[2];
  array.bytes = type[2] == 'U' ? 4 * uint64_t(size) : size;
  array.fortran_order = header_value(header, "'fortran_order'", file, offset).starts_with("True");
  array.shape = parse_shape(header_value(header, "'shape'", file, offset), file, offset);
  array.offset = stream.offset();
  array.end = end;
  if (array.elements() > (end - array.offset) / array.bytes)
    fail_input(file.path(), "has an array that is larger than the file", offset);
  return array;
}

bool is_integer(const NpyArray& a) {
  const bool size = a.bytes == 1 || a.bytes == 2 || a.bytes == 4 || a.bytes == 8;
  return (a.kind == 'i' || a.kind == 'u') && size;
}

uint64_t read_integer(ByteStream* stream, const NpyArray& array) {
  uint64_t bits = 0;
  stream->read(std::as_writable_bytes(std::span(&bits, 1)).first(array.bytes));
  const int unused = 64 - 8 * int(array.bytes);
  if (array.big_endian) bits = __builtin_bswap64(bits) >> unused;
  return array.kind == 'i' ? uint64_t(int64_t(bits << unused) >> unused) : bits;
}

void begin_array(ZipWriter* zip, const std::string& name, const std::string& type,
                 const std::string& shape) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  constexpr size_t kPrefixBytes = 10;  // magic, version, length
  header.resize((kPrefixBytes + header.size() + 1 + 63) / 64 * 64 - kPrefixBytes - 1, ' ');
  header += '\n';
  zip->begin(name + ".npy");
  zip->put(kNpyMagic);
  zip->put(uint8_t(1));
  zip->put(uint8_t(0));
  zip->put(uint16_t(header.size()));
  zip->put(header);
}

void put_placement(ZipWriter* zip, const Point& corner, double voxel_size) {
  begin_array(zip, "corner", "<f8", "(3,)");
  for (int a = 0; a < 3; ++a) zip->put(corner[a]);
  zip->end();
  begin_array(zip, "voxel_size", "<f8", "()");
  zip->put(voxel_size);
  zip->end();
}

}  // namespace svdag
