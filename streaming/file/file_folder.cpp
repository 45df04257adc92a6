#include "streaming/file/file_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#include <algorithm>

#include <filesystem>
#include <memory>
#include <utility>

#include "streaming/file/system_call.h"

namespace svdag {
namespace {

// O_NONBLOCK: opening a planted pipe must not hang.
constexpr int kFile = O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;

bool same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

uint64_t free_bytes_in(const struct statvfs& disk) {
  return uint64_t(disk.f_bavail) * disk.f_frsize;
}

}  // namespace

Folder Folder::open_or_create_folder(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();  // "link/" would follow the link
  int fd = -1;
  bool created = false;
  do {  // again if the owner of the folder removes it between the two calls
    created = ::mkdir(path.c_str(), 0700) == 0;
    if (!created && errno != EEXIST)
      fail_call(ExitCode::kOutput, "cannot write in this folder", folder_of(path), errno);
    fd = retry_interrupted([&] { return ::open(path.c_str(), kFolder); });
  } while (fd < 0 && errno == ENOENT);
  if (fd < 0 && created) {
    const int error = errno;
    ::rmdir(path.c_str());
    errno = error;
  }
  if (fd < 0 && (errno == ENOTDIR || errno == ELOOP))
    throw Error(ExitCode::kOutput, "is a link or a file, not a folder: choose another path", path);
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot be opened", path, errno);
  Folder folder(fd, std::move(path));
  folder.created_ = created;
  return folder;
}

Folder Folder::open_private(std::string path) {
  Folder folder = open_or_create_folder(std::move(path));
  struct stat status;
  try {
    status = folder.status();
    if (status.st_uid != ::geteuid() && !folder.new_files_belong_to(status.st_uid))
      throw Error(ExitCode::kOutput, "belongs to another user", folder.path_);
  } catch (const std::exception&) {
    if (folder.created_) ::rmdir(folder.path_.c_str());
    throw;
  }
  // Closes an existing folder to other users. This fails on file systems without permissions, where
  // there is nothing to protect.
  if ((status.st_mode & 0777) != 0700) (void)!::fchmod(folder.fd_, 0700);
  return folder;
}

Folder Folder::open_shared(std::string path) {
  Folder folder = open_or_create_folder(std::move(path));
  if (!folder.created_ && (folder.status().st_mode & S_IWOTH) != 0)
    throw Error(ExitCode::kUsage,
                "this folder is world-writable, and its files would be trusted: choose "
                "one of your own, or of your group",
                folder.path_);
  return folder;
}

Folder::Folder(Folder&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)), created_(other.created_) {}

Folder::~Folder() {
  if (fd_ >= 0) ::close(fd_);
}

// A file server or a mount may map this user to another one. It then maps new files, too.
bool Folder::new_files_belong_to(uid_t owner) const {
  const File probe = File::create_anonymous("/proc/self/fd/" + std::to_string(fd_), path_);
  struct stat status;
  return ::fstat(probe.descriptor(), &status) == 0 && status.st_uid == owner;
}

struct stat Folder::status() const {
  struct stat status;
  if (::fstat(fd_, &status) != 0) fail_call(ExitCode::kOutput, "cannot be examined", path_, errno);
  return status;
}

bool Folder::has(const std::string& name) const {
  struct stat status;
  return ::fstatat(fd_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(status.st_mode);
}

File Folder::create(const std::string& name) const {
  const int fd = retry_interrupted(
      [&] { return ::openat(fd_, name.c_str(), kFile | O_CREAT | O_EXCL, 0600); });
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot be created", path_of(name), errno);
  return File(fd, path_of(name), ExitCode::kOutput);
}

File Folder::open(const std::string& name) const {
  return regular(retry_interrupted([&] { return ::openat(fd_, name.c_str(), kFile); }), name);
}

File Folder::open_or_create(const std::string& name) const {
  const int fd =
      retry_interrupted([&] { return ::openat(fd_, name.c_str(), kFile | O_CREAT, 0600); });
  if (fd < 0 && errno == ENOENT) return {};
  return regular(fd, name);
}

// Returns the File of `fd`, which was just opened as `name`. Rejects one with several hard links:
// another link may be in a folder that other users can write.
File Folder::regular(int fd, const std::string& name) const {
  constexpr const char* kNotOwn = "is not a regular file, or has other hard links: remove it";
  if (fd < 0 && (errno == ELOOP || errno == EISDIR || errno == ENXIO))
    throw Error(ExitCode::kOutput, kNotOwn, path_of(name));
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot be opened", path_of(name), errno);
  File file(fd, path_of(name), ExitCode::kOutput);
  struct stat status;
  if (::fstat(fd, &status) != 0)
    fail_call(ExitCode::kOutput, "cannot be examined", path_of(name), errno);
  if (!S_ISREG(status.st_mode) || status.st_nlink > 1)
    throw Error(ExitCode::kOutput, kNotOwn, path_of(name));
  return file;
}

void Folder::remove(const std::string& name) const {
  if (::unlinkat(fd_, name.c_str(), 0) != 0 && errno != ENOENT)
    fail_call(ExitCode::kOutput, "cannot be removed", path_of(name), errno);
}

std::vector<std::string> Folder::names() const {
  // A second descriptor, because reading moves its position.
  const int fd = retry_interrupted([&] { return ::openat(fd_, ".", kFolder); });
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot be listed", path_, errno);
  const auto close = [](DIR* list) { ::closedir(list); };
  const std::unique_ptr<DIR, decltype(close)> list(::fdopendir(fd), close);
  if (list == nullptr) fail_call(ExitCode::kOutput, "cannot be listed", path_, errno);
  std::vector<std::string> names;
  errno = 0;  // readdir() returns null at the end and for an error, which sets errno
  while (const dirent* entry = ::readdir(list.get())) {
    const std::string name = entry->d_name;
    if (name != "." && name != "..") names.push_back(name);
    errno = 0;
  }
  if (errno != 0) fail_call(ExitCode::kOutput, "cannot be listed", path_, errno);
  return names;
}

bool Folder::holds(const File& file, const std::string& name) const {
  struct stat opened, named, folder, here;
  return ::fstat(file.descriptor(), &opened) == 0 &&
         ::fstatat(fd_, name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 && same(opened, named) &&
         ::fstat(fd_, &folder) == 0 && ::lstat(path_.c_str(), &here) == 0 && same(folder, here);
}

void Folder::sync() const {
  if (::fsync(fd_) != 0) fail_folder_sync(path_, errno);
}

uint64_t Folder::free_bytes() const {
  struct statvfs status;
  if (retry_interrupted([&] { return ::fstatvfs(fd_, &status); }) != 0)
    fail_call(ExitCode::kOutput, "cannot be examined", path_, errno);
  return free_bytes_in(status);
}

bool Folder::remove_itself() const {
  if (::rmdir(path_.c_str()) == 0) return true;
  if (errno != ENOTEMPTY && errno != EEXIST)
    fail_call(ExitCode::kOutput, "cannot be removed", path_, errno);
  return false;
}

uint64_t free_bytes_of(const std::string& folder) {
  struct statvfs disk;
  if (retry_interrupted([&] { return ::statvfs(folder.c_str(), &disk); }) != 0) return UINT64_MAX;
  const bool counts_files = disk.f_files != 0;  // btrfs does not
  return counts_files && disk.f_favail == 0 ? 0 : free_bytes_in(disk);
}

bool is_inside(const std::string& folder, const std::string& path) {
  std::error_code no_folder, no_path;
  const auto top = std::filesystem::canonical(folder, no_folder);
  const auto real = std::filesystem::canonical(path, no_path);
  return !no_folder && !no_path && std::ranges::mismatch(top, real).in1 == top.end();
}

std::string absolute_path(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error).lexically_normal();
  const fs::path folder = fs::weakly_canonical(absolute.parent_path(), error);
  return error ? absolute.string() : (folder / absolute.filename()).string();
}

}  // namespace svdag
