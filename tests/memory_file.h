// A File over bytes in memory, for tests of readers without files on disk.
//
// Creating and opening such a file takes ten times as long as reading a small one, so each thread
// reuses those that it has created. Therefore even a second File, opened by path(), is valid only
// while the MemoryFile exists.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : memory_(unused_or_new()) {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::pwrite(memory_.fd, bytes.data() + done, bytes.size() - done, off_t(done));
      if (n <= 0) throw std::runtime_error("cannot write a memory file");
      done += size_t(n);
    }
    if (bytes.size() < memory_.size && ::ftruncate(memory_.fd, off_t(bytes.size())) != 0)
      throw std::runtime_error("cannot truncate a memory file");
    memory_.size = bytes.size();
  }
  explicit MemoryFile(std::string_view text) : MemoryFile(std::as_bytes(std::span(text))) {}
  ~MemoryFile() { unused().push_back(std::move(memory_)); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const File& file() const { return memory_.file; }

 private:
  struct Memory {
    Memory() : fd(::memfd_create("memory_file", MFD_CLOEXEC)) {
      if (fd < 0) throw std::runtime_error("memfd_create failed");
      file = File::open_read("/proc/self/fd/" + std::to_string(fd));
    }
    Memory(Memory&& other) noexcept
        : fd(std::exchange(other.fd, -1)), size(other.size), file(std::move(other.file)) {}
    ~Memory() {
      if (fd >= 0) ::close(fd);
    }

    int fd;
    uint64_t size = 0;
    File file;
  };

  static std::vector<Memory>& unused() {
    static thread_local std::vector<Memory> list;
    return list;
  }
  static Memory unused_or_new() {
    if (unused().empty()) return Memory();
    Memory memory = std::move(unused().back());
    unused().pop_back();
    return memory;
  }

  Memory memory_;
};

}  // namespace svdag
