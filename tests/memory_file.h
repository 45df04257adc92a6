// A File over bytes in memory, for tests: the readers take files, and a test should write none.
//
// Making such a file and opening it is ten times the work of reading a small one, so a thread keeps
// those it has made and writes the next bytes into one that is no longer in use. A File of one's
// own, opened by its path(), is therefore valid as long as the MemoryFile.
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
  explicit MemoryFile(std::span<const std::byte> bytes) : memory_(take()) {
    for (size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::pwrite(memory_.fd, bytes.data() + done, bytes.size() - done, off_t(done));
      if (n <= 0) throw std::runtime_error("cannot write a memory file");
      done += size_t(n);
    }
    if (bytes.size() < memory_.size && ::ftruncate(memory_.fd, off_t(bytes.size())) != 0)
      throw std::runtime_error("cannot cut a memory file");
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
  static Memory take() {
    if (unused().empty()) return Memory();
    Memory memory = std::move(unused().back());
    unused().pop_back();
    return memory;
  }

  Memory memory_;
};

}  // namespace svdag
