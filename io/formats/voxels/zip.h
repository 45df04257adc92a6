// Zip archives of stored (not compressed) entries, with 64-bit sizes: what `.npz` files are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/formats/output.h"
#include "streaming/file/file.h"

namespace svdag {

// Writes the entries one after the other; sizes and checksum of each are filled in at its end.
class ZipWriter {
 public:
  explicit ZipWriter(const std::string& path) : out_(path) {}

  void begin(const std::string& name);
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { put(std::as_bytes(std::span(&value, 1))); }
  void put(std::string_view text) { put(std::as_bytes(std::span(text))); }
  void put(std::span<const std::byte> bytes);
  void end();
  // Writes the directory; the file gets its name.
  void commit();

 private:
  struct Entry {
    std::string name;
    uint64_t offset = 0, bytes = 0;
    uint32_t crc = 0;
  };

  void put_sizes(const Entry& entry);

  Output out_;
  std::vector<Entry> entries_;
  uint64_t begin_ = 0;  // of the current entry's bytes
};

// A stored entry of an archive: where its bytes are.
struct ZipEntry {
  std::string name;
  uint64_t offset, bytes;
  uint32_t crc;  // as the directory says
};

// The entries of an archive. Anything but a zip file without compressed entries is an Error
// (kBadInput).
std::vector<ZipEntry> read_zip(const File& file);

// Reads the entry once to its end: an Error (kBadInput) if its bytes are not those of its checksum.
void require_sound(const File& file, const ZipEntry& entry);

}  // namespace svdag
