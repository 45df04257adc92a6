// The files of a zip archive in memory, unpacked in pieces with minizip.
//
// For a limited child only: minizip parses untrusted bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace svdag {

class ZipArchive {
 public:
  // `bytes` must outlive the archive. `path`: of the archive, for errors. Not an archive: Error
  // (kBadInput), "is not a valid `format` file".
  ZipArchive(std::span<const std::byte> bytes, const std::string& path, const char* format);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  // Unpacks the file of this name (upper and lower case are the same) and passes on its bytes, the
  // last time with is_last. Returns false if there is none. Damaged or encrypted: Error
  // (kBadInput).
  using PieceSink = std::function<void(std::string_view piece, bool is_last)>;
  bool unpack(const std::string& name, const PieceSink& sink) const;

 private:
  struct Position;

  const std::string& path_;
  void* zip_ = nullptr;
};

}  // namespace svdag
