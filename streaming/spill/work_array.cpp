#include "streaming/spill/work_array.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <cerrno>
#include <filesystem>

#include "streaming/file/file_folder.h"
#include "streaming/file/system_call.h"

namespace svdag {
namespace {

// Gives the file blocks for `bytes` bytes: where a sparse file is mapped, a full disk is a SIGBUS.
void allocate_blocks(File* file, uint64_t bytes, const std::string& folder) {
  if (bytes <= free_bytes_of(folder)) {
    int error = EINTR;
    while (error == EINTR) error = posix_fallocate(file->descriptor(), 0, off_t(bytes));
    if (error == 0) return;
    if (error != ENOSPC) fail_call(ExitCode::kOutput, "allocating", folder, error);
  }
  throw Error(ExitCode::kOutput,
              "has less than " + std::to_string(bytes / 1'000'000 + 1) +
                  " MB free for an array of nodes: give more --memory, or another folder",
              folder);
}

}  // namespace

WorkRoom temporary_room(MemoryBudget* budget) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) throw Error(ExitCode::kOutput, "TMPDIR does not name a folder: set it to one");
  return {budget, folder.string()};
}

WorkMemory::WorkMemory(uint64_t bytes, const WorkRoom& room)
    : counted_(room.budget->reserve(0, "layout")) {
  if (bytes == 0) return;
  const uint64_t half = room.budget->limit() / 2, used = room.budget->used();
  if (used <= half && bytes <= half - used && counted_.try_resize(bytes)) {
    pages_ = HugePages(bytes);
    return;
  }
  File file = File::create_anonymous(room.folder);
  allocate_blocks(&file, bytes, room.folder);
  void* const mapped =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file.descriptor(), 0);
  if (mapped == MAP_FAILED) fail_call(ExitCode::kOutput, "mapping", room.folder, errno);
  mapped_ = mapped;
  mapped_bytes_ = bytes;
}

WorkMemory& WorkMemory::operator=(WorkMemory&& other) noexcept {
  std::swap(counted_, other.counted_);
  std::swap(pages_, other.pages_);
  std::swap(mapped_, other.mapped_);
  std::swap(mapped_bytes_, other.mapped_bytes_);
  return *this;
}

WorkMemory::~WorkMemory() {
  if (mapped_ != nullptr) munmap(mapped_, mapped_bytes_);
}

}  // namespace svdag
