// A File over bytes in memory, for tests: the readers take files, and a test should write none.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "streaming/file.h"

namespace svdag {

class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : fd_(::memfd_create("memory_file", 0)) {
    if (fd_ < 0) throw std::runtime_error("memfd_create failed");
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
      if (n <= 0) throw std::runtime_error("cannot write a memory file");
      done += size_t(n);
    }
    file_ = File::open_read("/proc/self/fd/" + std::to_string(fd_));
  }
  explicit MemoryFile(std::string_view text) : MemoryFile(std::as_bytes(std::span(text))) {}
  ~MemoryFile() { ::close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const File& file() const { return file_; }

 private:
  int fd_;
  File file_;
};

}  // namespace svdag
