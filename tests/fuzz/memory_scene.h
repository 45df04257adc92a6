// Lets a scene reader loose on bytes in memory, through a file that has no name.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/scene/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {

using SceneReader = void (*)(const File&, const ReadOptions&, const TriangleSink&);

// Bad input and too small a budget are expected; any other error, and any leak, is a defect.
inline void read_from_memory(SceneReader reader, const uint8_t* data, size_t size) {
  const int fd = memfd_create("scene", MFD_CLOEXEC);
  if (fd < 0 || write(fd, data, size) != ssize_t(size)) std::abort();
  MemoryBudget budget(uint64_t(256) << 20);
  const NameFilter all;
  try {
    const File file = File::open_read("/proc/self/fd/" + std::to_string(fd));
    reader(file, {&all, false, &budget}, [](const TriangleBatch& batch) {
      if (batch.triangles.empty()) std::abort();
    });
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kMemory) std::abort();
  }
  if (budget.used() != 0) std::abort();
  close(fd);
}

}  // namespace svdag
