#include "streaming/atomic_file.h"

#include <algorithm>

namespace svdag {

AtomicFile::AtomicFile(const std::string& target)
    : target_(target), file_(File::create_anonymous(folder_of(target), target)) {}

void AtomicFile::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  file_.write_at(offset, bytes);
  size_ = std::max(size_, offset + bytes.size());
}

void AtomicFile::append(std::span<const std::byte> bytes) {
  write_at(size_, bytes);
}

void AtomicFile::commit() {
  file_.sync();
  file_.link_as(target_);
  file_.close();
  sync_folder(folder_of(target_));
}

}  // namespace svdag
