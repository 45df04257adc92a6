#include "io/scene/decoders/zip_archive.h"

#include <unzip.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "streaming/error.h"

namespace svdag {

// What minizip takes for a file.
struct ZipArchive::Position {
  std::span<const std::byte> bytes;
  uint64_t at = 0;

  static void* open(void* opaque, const void*, int) {
    return new Position(*static_cast<Position*>(opaque));
  }
  static uLong read(void*, void* stream, void* out, uLong size) {
    auto& file = *static_cast<Position*>(stream);
    const uint64_t count = std::min<uint64_t>(size, file.bytes.size() - file.at);
    if (count > 0) std::memcpy(out, file.bytes.data() + file.at, count);
    file.at += count;
    return uLong(count);
  }
  static ZPOS64_T tell(void*, void* stream) { return static_cast<Position*>(stream)->at; }
  static long seek(void*, void* stream, ZPOS64_T offset, int origin) {
    auto& file = *static_cast<Position*>(stream);
    uint64_t from = 0;
    if (origin == ZLIB_FILEFUNC_SEEK_CUR) from = file.at;
    if (origin == ZLIB_FILEFUNC_SEEK_END) from = file.bytes.size();
    if (offset > file.bytes.size() - from) return -1;
    file.at = from + offset;
    return 0;
  }
  static int close(void*, void* stream) {
    delete static_cast<Position*>(stream);
    return 0;
  }
  static int error(void*, void*) { return 0; }
};

ZipArchive::ZipArchive(std::span<const std::byte> bytes, const std::string& path,
                       const char* format)
    : path_(path) {
  Position start = {bytes};
  zlib_filefunc64_def functions = {Position::open, Position::read,  nullptr,         Position::tell,
                                   Position::seek, Position::close, Position::error, &start};
  zip_ = unzOpen2_64(path.c_str(), &functions);
  if (zip_ == nullptr)
    fail_input(path, std::string("is not a valid ") + format + " file: it is not a zip archive");
}

ZipArchive::~ZipArchive() {
  unzClose(zip_);
}

bool ZipArchive::unpack(const std::string& name, const PieceSink& sink) const {
  constexpr int kIgnoreCase = 2;
  constexpr size_t kMaxName = 255;  // minizip compares no longer names
  if (name.empty() || name.size() > kMaxName ||
      unzLocateFile(zip_, name.c_str(), kIgnoreCase) != UNZ_OK)
    return false;
  const std::string damaged = "damaged zip archive: " + name + " cannot be unpacked";
  unz_file_info64 info;
  if (unzGetCurrentFileInfo64(zip_, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    fail_input(path_, damaged);
  if ((info.flag & 1) != 0) fail_input(path_, name + " is encrypted, which svdag does not read");
  if (unzOpenCurrentFile(zip_) != UNZ_OK) fail_input(path_, damaged);
  std::vector<char> piece(size_t(1) << 16);
  int count = 0;
  while ((count = unzReadCurrentFile(zip_, piece.data(), unsigned(piece.size()))) > 0)
    sink({piece.data(), size_t(count)}, false);
  // Closing compares the checksum.
  if (count < 0 || unzCloseCurrentFile(zip_) != UNZ_OK) fail_input(path_, damaged);
  sink({}, true);
  return true;
}

}  // namespace svdag
