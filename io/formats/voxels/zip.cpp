#include "io/formats/voxels/zip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <optional>

#include "streaming/error.h"
#include "streaming/file/byte_stream.h"
#include "streaming/file/file_folder.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr uint32_t kLocal = 0x04034b50, kCentral = 0x02014b50, kEnd = 0x06054b50,
                   kEnd64 = 0x06064b50, kLocator64 = 0x07064b50;
constexpr uint16_t kZipVersion = 45;  // the first with 64-bit sizes
constexpr uint16_t kExtra64 = 1;
constexpr uint16_t kStored = 0, kDeflated = 8;  // methods
constexpr uint32_t kIn64BitField = 0xffffffff;
constexpr uint16_t kDay = 1 << 5 | 1;  // 1 January 1980: makes archives reproducible

uint32_t add_to_crc(uint32_t crc, std::span<const std::byte> bytes) {
  return uint32_t(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// The fields common to local headers and the directory, from the version to the sizes.
void put_common(uint32_t crc, Output* out) {
  out->put(kZipVersion);
  out->put(uint16_t(0));  // flags
  out->put(uint16_t(0));  // stored
  out->put(uint16_t(0));  // time
  out->put(kDay);
  out->put(crc);
  out->put(kIn64BitField);  // both sizes
  out->put(kIn64BitField);
}

}  // namespace

void ZipWriter::begin(const std::string& name) {
  entries_.push_back({name, out_.size()});
  out_.put(kLocal);
  put_common(0, &out_);
  out_.put(uint16_t(name.size()));
  out_.put(uint16_t(20));
  out_.put(name);
  out_.put(kExtra64);
  out_.put(uint16_t(16));
  out_.put(uint64_t(0));
  out_.put(uint64_t(0));
  begin_ = out_.size();
}

void ZipWriter::put(std::span<const std::byte> bytes) {
  entries_.back().crc = add_to_crc(entries_.back().crc, bytes);
  out_.put(bytes);
}

void ZipWriter::end() {
  DirectoryEntry& entry = entries_.back();
  entry.bytes = out_.size() - begin_;
  out_.patch(entry.offset + 14, entry.crc);
  out_.patch(begin_ - 16, entry.bytes);
  out_.patch(begin_ - 8, entry.bytes);
}

void ZipWriter::put_sizes(const DirectoryEntry& entry) {
  out_.put(kExtra64);
  out_.put(uint16_t(24));
  out_.put(entry.bytes);
  out_.put(entry.bytes);
  out_.put(entry.offset);
}

void ZipWriter::commit() {
  const uint64_t directory = out_.size();
  for (const DirectoryEntry& entry : entries_) {
    out_.put(kCentral);
    out_.put(kZipVersion);
    put_common(entry.crc, &out_);
    out_.put(uint16_t(entry.name.size()));
    out_.put(uint16_t(28));
    for (int i = 0; i < 3; ++i) out_.put(uint16_t(0));  // comment, disk, attributes
    out_.put(uint32_t(0));
    out_.put(kIn64BitField);
    out_.put(entry.name);
    put_sizes(entry);
  }
  const uint64_t end = out_.size(), count = entries_.size();
  out_.put(kEnd64);
  out_.put(uint64_t(44));
  out_.put(kZipVersion);
  out_.put(kZipVersion);
  out_.put(uint64_t(0));  // disks
  for (const uint64_t n : {count, count, end - directory, directory}) out_.put(n);
  out_.put(kLocator64);
  out_.put(uint32_t(0));
  out_.put(end);
  out_.put(uint32_t(1));
  out_.put(kEnd);
  out_.put(uint32_t(0));
  out_.put(uint16_t(count));
  out_.put(uint16_t(count));
  out_.put(kIn64BitField);
  out_.put(kIn64BitField);
  out_.put(uint16_t(0));
  out_.commit();
}

namespace {

// A range of the file in memory; access beyond it is an Error.
class FileSlice {
 public:
  FileSlice(const File& file, uint64_t offset, uint64_t bytes) : file_(file), offset_(offset) {
    bytes_.resize(bytes);
    file.read_at(offset, bytes_);
  }
  template <class T>
  T at(uint64_t i) const {
    T value;
    std::memcpy(&value, bytes(i, sizeof value).data(), sizeof value);
    return value;
  }
  std::span<const std::byte> bytes(uint64_t i, uint64_t size) const {
    if (i > bytes_.size() || size > bytes_.size() - i)
      fail_input(file_.path(), "damaged zip file: its directory is truncated", offset_ + i);
    return std::span(bytes_).subspan(i, size);
  }
  uint64_t size() const { return bytes_.size(); }

 private:
  const File& file_;
  uint64_t offset_;
  std::vector<std::byte> bytes_;
};

struct DirectoryRange {
  uint64_t offset, bytes;
};

DirectoryRange find_directory(const File& file) {
  constexpr uint64_t kRecord = 22, kMaxCommentBytes = 65535, kLocator = 20;
  const uint64_t size = file.size();
  if (size < kRecord) fail_input(file.path(), "is not a zip file");
  const uint64_t tail_bytes = std::min(size, kRecord + kMaxCommentBytes + kLocator);
  const FileSlice tail(file, size - tail_bytes, tail_bytes);
  for (uint64_t i = tail_bytes - kRecord + 1; i-- > 0;) {
    if (tail.at<uint32_t>(i) != kEnd) continue;
    if (i >= kLocator && tail.at<uint32_t>(i - kLocator) == kLocator64) {
      const uint64_t at = tail.at<uint64_t>(i - kLocator + 8);
      if (at > size || size - at < 56) break;
      const FileSlice end(file, at, 56);
      return {end.at<uint64_t>(48), end.at<uint64_t>(40)};
    }
    return {tail.at<uint32_t>(i + 16), tail.at<uint32_t>(i + 12)};
  }
  fail_input(file.path(), "is not a zip file (it has no directory)");
}

// Reads the sizes and the offset of an entry, as far as they are in its 64-bit extra field.
void read_extra64(const FileSlice& directory, uint64_t at, uint64_t bytes,
                  std::array<uint64_t*, 3> fields) {
  for (const uint64_t end = at + bytes; at + 4 <= end;) {
    const uint16_t kind = directory.at<uint16_t>(at), length = directory.at<uint16_t>(at + 2);
    at += 4;
    uint64_t next = at;
    for (uint64_t* field : fields) {
      if (kind != kExtra64 || *field != kIn64BitField) continue;
      *field = directory.at<uint64_t>(next);
      next += 8;
    }
    at += length;
  }
}

}  // namespace

std::vector<ZipEntry> read_zip(const File& file) {
  constexpr uint64_t kMaxDirectoryBytes = uint64_t(1) << 24;
  const uint64_t size = file.size();
  const DirectoryRange place = find_directory(file);
  if (place.offset > size || place.bytes > size - place.offset || place.bytes > kMaxDirectoryBytes)
    fail_input(file.path(), "damaged zip file: its directory is out of range");
  const FileSlice directory(file, place.offset, place.bytes);
  std::vector<ZipEntry> entries;
  for (uint64_t at = 0; at < directory.size();) {
    if (directory.at<uint32_t>(at) != kCentral)
      fail_input(file.path(), "damaged zip file: invalid directory entry", place.offset + at);
    uint64_t packed = directory.at<uint32_t>(at + 20), bytes = directory.at<uint32_t>(at + 24);
    uint64_t local = directory.at<uint32_t>(at + 42);
    const uint64_t name = directory.at<uint16_t>(at + 28), extra = directory.at<uint16_t>(at + 30);
    const auto text = directory.bytes(at + 46, name);
    ZipEntry entry{{reinterpret_cast<const char*>(text.data()), text.size()},
                   0,
                   0,
                   directory.at<uint32_t>(at + 16),
                   0,
                   false};
    read_extra64(directory, at + 46 + name, extra, {&bytes, &packed, &local});
    const uint16_t method = directory.at<uint16_t>(at + 10);
    if ((method != kStored && method != kDeflated) || (method == kStored && packed != bytes))
      fail_input(file.path(), entry.name +
                                  " is not compressed by deflate: write the archive with "
                                  "numpy.savez or numpy.savez_compressed");
    entry.is_deflated = method == kDeflated;
    entry.packed = packed;
    if (local > size || size - local < 30)
      fail_input(file.path(), "damaged zip file: an entry is out of range", place.offset + at);
    const FileSlice head(file, local, 30);
    entry.offset = local + 30 + head.at<uint16_t>(26) + head.at<uint16_t>(28);
    entry.bytes = bytes;
    if (head.at<uint32_t>(0) != kLocal || entry.offset > size || packed > size - entry.offset)
      fail_input(file.path(), "damaged zip file: an entry is out of range", local);
    entries.push_back(entry);
    at += 46 + name + extra + directory.at<uint16_t>(at + 32);
  }
  return entries;
}

namespace {

// Inflates an entry to exactly entry.bytes bytes of `out` from `begin` on.
void inflate_entry(const File& file, const ZipEntry& entry, uint64_t begin, File* out) {
  z_stream state{};
  if (inflateInit2(&state, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> ends(&state, &inflateEnd);
  ByteStream stream(file, entry.offset, entry.offset + entry.packed);
  std::vector<std::byte> block(size_t(1) << 18);
  uint64_t done = 0;
  for (int result = Z_OK; result != Z_STREAM_END;) {
    check_interrupt();
    const auto bytes = stream.peek();
    state.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));  // only read
    state.avail_in = uInt(bytes.size());
    state.next_out = reinterpret_cast<Bytef*>(block.data());
    state.avail_out = uInt(block.size());
    result = inflate(&state, Z_NO_FLUSH);
    const size_t count = block.size() - state.avail_out;
    const bool stuck = count == 0 && state.avail_in == bytes.size();
    if ((result != Z_OK && result != Z_STREAM_END) || stuck || count > entry.bytes - done) break;
    out->write_at(begin + done, std::span(block).first(count));
    done += count;
    stream.skip(bytes.size() - state.avail_in);
    if (result == Z_STREAM_END && done == entry.bytes) return;
  }
  fail_input(file.path(), "damaged zip file: " + entry.name + " cannot be unpacked", entry.offset);
}

}  // namespace

File inflate_entries(const File& file, const std::string& folder, std::vector<ZipEntry>* entries) {
  const uint64_t free = free_bytes_of(folder);
  uint64_t left = free - free / 16;  // other programs need some
  File out = File::create_anonymous(folder, file.path());
  uint64_t end = 0;
  for (ZipEntry& entry : *entries) {
    if (entry.bytes > left)
      throw Error(ExitCode::kOutput,
                  "has no room for the content of " + file.path() + ": set TMPDIR to another folder",
                  folder);
    left -= entry.bytes;
    if (entry.is_deflated) {
      inflate_entry(file, entry, end, &out);
    } else {
      ByteStream stored(file, entry.offset, entry.offset + entry.bytes);
      uint64_t at = end;
      for (auto bytes = stored.peek(); !bytes.empty(); bytes = stored.peek()) {
        out.write_at(at, bytes);
        at += bytes.size();
        stored.skip(bytes.size());
      }
    }
    entry.offset = end;
    end += entry.bytes;
  }
  return out;
}

void check_crc(const File& file, const ZipEntry& entry) {
  ByteStream stream(file, entry.offset, entry.offset + entry.bytes);
  uint32_t crc = 0;
  for (auto bytes = stream.peek(); !bytes.empty(); bytes = stream.peek()) {
    crc = add_to_crc(crc, bytes);
    stream.skip(bytes.size());
  }
  if (crc != entry.crc)
    fail_input(file.path(), "damaged zip file: " + entry.name + " does not match its checksum");
}

}  // namespace svdag
