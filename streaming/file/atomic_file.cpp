#include "streaming/file/atomic_file.h"

#include <algorithm>
#include <filesystem>

#include "streaming/file/mapped_file.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

std::string checked(const std::string& target) {
  AtomicFile::check(target);
  return output_target(target);
}

}  // namespace

std::string output_target(std::string path) {
  constexpr int kMaxLinks = 40;  // as the kernel
  for (int i = 0; i < kMaxLinks; ++i) {
    std::error_code error;
    const fs::path next = fs::read_symlink(path, error);
    if (error) return path;
    path = next.is_absolute() ? next.native() : folder_of(path) + "/" + next.native();
  }
  return path;
}

// rename() replaces any file of the name; as root, even /dev/null.
void AtomicFile::check(const std::string& target, bool keep_existing) {
  if (target == "-")
    throw Error(ExitCode::kUsage, "-: standard output is not supported: name an output file");
  std::error_code error;
  const fs::file_type type = fs::status(target, error).type();
  if (error == std::errc::filename_too_long)
    throw Error(ExitCode::kOutput, "the file name is too long: choose a shorter one", target);
  if (error == std::errc::too_many_symbolic_link_levels)
    throw Error(ExitCode::kOutput, "is a loop of symbolic links: choose another name", target);
  if (type == fs::file_type::directory)
    throw Error(ExitCode::kOutput, "is a folder: name a file in it", target);
  const bool free = type == fs::file_type::not_found || type == fs::file_type::regular ||
                    type == fs::file_type::none;  // unknown: opening it will report why
  const bool descriptor = fs::read_symlink(target, error).native().starts_with("/proc/");
  if (!free || descriptor)
    throw Error(ExitCode::kOutput,
                "is not a regular file and cannot be replaced: choose another name", target);
  if (keep_existing && type == fs::file_type::regular)
    throw Error(ExitCode::kUsage, "already exists: choose another name, or omit --no-clobber",
                target);
}

AtomicFile::AtomicFile(const std::string& target)
    : target_(checked(target)),
      file_(File::create_anonymous(folder_of(target), target, File::kOutputMode)) {}

void AtomicFile::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  file_.write_at(offset, bytes);
  const uint64_t end = offset + bytes.size();
  for (uint64_t size = size_; size < end && !size_.compare_exchange_weak(size, end);) {
  }
}

void AtomicFile::append(std::span<const std::byte> bytes) {
  write_at(size_, bytes);
}

void AtomicFile::commit() {
  file_.sync();
  require_mapped_files();
  check(target_);  // again: the target may have been created since the constructor
  file_.link_as(target_);
  file_.close();
  sync_folder(folder_of(target_));
}

}  // namespace svdag
