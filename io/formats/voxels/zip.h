// Reader and writer of zip archives with 64-bit sizes, the container of `.npz` files. Written entries
// are stored, read ones stored or deflated.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/formats/output.h"
#include "streaming/file/file.h"

namespace svdag {

// Writes entries one after the other; the sizes and checksum of each are patched in at its end.
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
  // Writes the directory and renames the file to its final name.
  void commit();

 private:
  struct DirectoryEntry {
    std::string name;
    uint64_t offset = 0, bytes = 0;
    uint32_t crc = 0;
  };

  void put_sizes(const DirectoryEntry& entry);

  Output out_;
  std::vector<DirectoryEntry> entries_;
  uint64_t begin_ = 0;  // offset of the current entry's bytes
};

// An entry of an archive and the range of its bytes.
struct ZipEntry {
  std::string name;
  uint64_t offset, bytes;
  uint32_t crc;        // from the directory
  uint64_t packed;     // size of its deflated bytes at `offset`
  bool is_deflated;
};

// The entries of an archive. Any other file, or a method other than deflate, is an Error (kBadInput).
std::vector<ZipEntry> read_zip(const File& file);

// An anonymous file in the folder with the contents of these entries, whose places change to those
// in it. Errors: kBadInput, and kOutput if the folder has no room for them.
File inflate_entries(const File& file, const std::string& folder, std::vector<ZipEntry>* entries);

// Reads the whole entry; a checksum mismatch is an Error (kBadInput).
void check_crc(const File& file, const ZipEntry& entry);

}  // namespace svdag
