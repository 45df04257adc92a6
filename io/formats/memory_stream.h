// A seekable std::istream over bytes in memory, for libraries that read streams in a process that
// may not open files.
#pragma once

#include <cstddef>
#include <istream>
#include <span>
#include <streambuf>

namespace svdag {

class MemoryBuffer final : public std::streambuf {
 public:
  explicit MemoryBuffer(std::span<const std::byte> bytes) {
    // setg() takes char*, but an input streambuf never writes through it.
    char* begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());
  }

 protected:
  // A position outside of the bytes fails, which sets the stream's failbit.
  pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const off_type size = egptr() - eback();
    const off_type base = from == std::ios_base::beg   ? 0
                          : from == std::ios_base::end ? size
                                                       : gptr() - eback();
    if (by < -base || by > size - base) return pos_type(off_type(-1));
    setg(eback(), eback() + (base + by), egptr());
    return pos_type(base + by);
  }
  pos_type seekpos(pos_type at, std::ios_base::openmode mode) override {
    return seekoff(off_type(at), std::ios_base::beg, mode);
  }
};

// Reading beyond the end throws std::ios_base::failure, so that no reader continues without data.
class MemoryStream final : public std::istream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : std::istream(nullptr), buffer_(bytes) {
    rdbuf(&buffer_);
    exceptions(std::ios_base::failbit | std::ios_base::badbit);
  }

 private:
  MemoryBuffer buffer_;
};

}  // namespace svdag
