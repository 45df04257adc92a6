// STL (3D Systems 1989): binary and text.
//
// A file is binary if its size matches its count of triangles, whatever it begins with: many
// binary files begin with "solid", too. Other bytes may follow the last triangle; a multiple of a
// triangle's may be triangles that the count lacks, and the file is rejected.
// In text, words may follow a keyword and its numbers, "end loop" is "endloop", and the last
// "endsolid" may be missing. A facet that is not complete is an Error.
// The normals and the attribute bytes are ignored. Solids of a text file have names, which serve as
// mesh names.
#include <array>
#include <cctype>

#include "io/scene/polygons/mesh_writer.h"
#include "io/values/endian.h"
#include "io/values/text_scan.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kBinaryHeader = 84;  // 80 bytes of text, the count
constexpr size_t kRecord = 50;        // normal, three corners, attribute
constexpr size_t kNormal = 12;

// The count of a binary file; at least kBinaryHeader bytes.
uint64_t binary_count(const File& file) {
  std::array<std::byte, 4> bytes;
  file.read_at(kBinaryHeader - bytes.size(), bytes);
  return load_little<uint32_t>(bytes.data());
}

// "solid" behind blanks, and no zero byte: a binary file has one at the latest in its count.
bool begins_as_text(const File& file) {
  std::array<char, 512> head{};
  const size_t n = file.read_some_at(0, std::as_writable_bytes(std::span(head)));
  std::string_view text(head.data(), n);
  if (text.find('\0') != std::string_view::npos) return false;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos || text.size() - start < 5) return false;
  for (size_t i = 0; i < 5; ++i) {
    if (std::tolower(static_cast<unsigned char>(text[start + i])) != "solid"[i]) return false;
  }
  return true;
}

void read_binary(const File& file, uint64_t count, MeshWriter* out) {
  ByteStream stream(file, kBinaryHeader);
  while (count > 0) {
    const auto bytes = stream.peek(kRecord);
    const uint64_t rows = std::min<uint64_t>(bytes.size() / kRecord, count);
    if (rows == 0) fail_input(file.path(), "ends too early", stream.offset());
    const std::byte* p = bytes.data() + kNormal;
    for (uint64_t i = 0; i < rows; ++i, p += kRecord) {
      std::array<Point, 3> v;
      for (size_t k = 0; k < 9; ++k)
        v[k / 3][int(k % 3)] = double(load_little<float>(p + k * sizeof(float)));
      out->add(v[0], v[1], v[2]);
    }
    stream.skip(rows * kRecord);
    count -= rows;
  }
}

class TextReader {
 public:
  TextReader(const File& file, const ReadOptions& options, MeshWriter* out)
      : options_(options), stream_(file), scanner_(&stream_, {}), out_(*out) {}

  LeftOut read() {
    LeftOut left_out;
    while (!scanner_.at_end()) {
      expect("solid");
      const std::string name(scanner_.rest_of_line());
      out_.mesh(name);
      const bool wanted = options_.wants(name);
      while (next_is_facet()) read_facet(wanted);
      if (!ended_) left_out.add(Omission::kNoEnd);
      scanner_.next_line();  // the name again
    }
    return left_out;
  }

 private:
  std::string_view next_word() {
    if (scanner_.at_end()) scanner_.fail("ends within a solid");
    return scanner_.word();
  }
  // "endloop", also of "end loop".
  std::string next_keyword() {
    std::string word(next_word());
    if (same(word, "end")) word += next_word();
    return word;
  }
  static bool same(std::string_view found, std::string_view wanted) {
    return std::equal(found.begin(), found.end(), wanted.begin(), wanted.end(), [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == b;
    });
  }
  // Words after the keyword before are skipped, up to the end of their line.
  void expect(const char* wanted) {
    if (scanner_.at_line_end()) return check(next_keyword(), wanted);
    const std::string word = next_keyword();
    if (same(word, wanted)) return;
    scanner_.next_line();
    check(next_keyword(), wanted);
  }
  void check(std::string_view found, const char* wanted) const {
    if (!same(found, wanted))
      scanner_.fail(std::string("has no \"") + wanted + "\" where it should");
  }
  // "facet" or the end of the solid.
  bool next_is_facet() {
    for (bool in_line = !scanner_.at_line_end();; in_line = false) {
      ended_ = !scanner_.at_end();
      if (!ended_) return false;
      const std::string found = next_keyword();
      if (same(found, "facet")) return true;
      if (same(found, "endsolid")) return false;
      if (!in_line) check(found, "facet");
      scanner_.next_line();
    }
  }
  void read_facet(bool wanted) {
    expect("normal");
    for (int i = 0; i < 3; ++i) next_word();  // often wrong, not needed
    expect("outer");
    expect("loop");
    std::array<Point, 3> v;
    for (Point& p : v) {
      expect("vertex");
      for (int a = 0; a < 3; ++a) p[a] = scanner_.number();
    }
    expect("endloop");
    expect("endfacet");
    if (wanted) out_.add(v[0], v[1], v[2]);
  }

  const ReadOptions& options_;
  ByteStream stream_;
  TextScanner scanner_;
  MeshWriter& out_;
  bool ended_ = true;  // the last solid, by "endsolid"
};

}  // namespace

LeftOut read_stl(const File& file, const ReadOptions& options, MeshWriter* out) {
  const uint64_t size = file.size();
  const uint64_t count = size < kBinaryHeader ? 0 : binary_count(file);
  const uint64_t expected = kBinaryHeader + kRecord * count;
  const bool padded = count > 0 && size > expected && (size - expected) % kRecord != 0;
  LeftOut left_out;
  if (size != expected && begins_as_text(file)) {
    left_out = TextReader(file, options, out).read();
  } else if (size == expected || padded) {
    if (options.wants("")) read_binary(file, count, out);
    if (size - expected >= kRecord) left_out.add(Omission::kBytesAfter, size - expected);
  } else if (size < kBinaryHeader) {
    fail_input(file.path(), "is too short for an STL file");
  } else {
    fail_input(file.path(), "promises " + std::to_string(count) + " triangles, which take " +
                                std::to_string(expected) + " bytes, but it has " +
                                std::to_string(size));
  }
  return left_out;
}

}  // namespace svdag
