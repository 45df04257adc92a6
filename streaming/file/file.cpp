#include "streaming/file/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "streaming/file/content_hash.h"
#include "streaming/file/system_call.h"

namespace svdag {
namespace {

// Describes the errno values that users meet; strerror() for the rest.
std::string reason(int error) {
  switch (error) {
    case ENOENT:
      return "no such file or folder";
    case EACCES:
    case EPERM:
      return "permission denied";
    case ENOSPC:
      return "the disk is full";
    case EDQUOT:
      return "the disk quota is used up";
    case EFBIG:
      return "the file exceeds the size limit (ulimit -f)";
    case EISDIR:
      return "it is a folder";
    case ENOTDIR:
      return "its path leads through a file";
    case EROFS:
      return "the file system is read-only";
    case EMFILE:
      return "this process has too many open files (ulimit -n)";
    case ESTALE:
      return "the file server has replaced or removed it";
    case ETIMEDOUT:
      return "the file server does not answer";
    case ENAMETOOLONG:
      return "its name is too long";
    case ELOOP:
      return "its symbolic links lead in a circle";
    case EEXIST:
      return "it exists";
    case EBUSY:
      return "it is in use";
    case EIO:
      return "the disk reports an error";
    default:
      return std::strerror(error);
  }
}

std::string random_suffix() {
  uint64_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) != ssize_t(sizeof bits)) bits = uint64_t(getpid());
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(bits));
  return text;
}

// Exit code of an errno value. Failures of the system, not of the file's content, have codes of
// their own: a retry, or more memory or space, may help.
ExitCode code_of(int error, ExitCode otherwise) {
  switch (error) {
    case EIO:
    case ESTALE:  // of a file server
    case ETIMEDOUT:
      return ExitCode::kOutput;
    case EMFILE:
    case ENFILE:
    case ENOMEM:
      return ExitCode::kMemory;
    default:
      return otherwise;
  }
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// True if `path` names the open file `fd`. A rename may be sent to a file server twice: the
// repeated request then fails although the rename was done.
bool is_name_of(const std::string& path, int fd) {
  struct stat own, named;
  return ::fstat(fd, &own) == 0 && ::stat(path.c_str(), &named) == 0 && is_same(own, named);
}

// True if link_as() can name an anonymous file, which it does through /proc.
bool can_be_named() {
  return ::access("/proc/self/fd", X_OK) == 0;
}

// Switches from direct transfers back to the page cache; false if it was in use already.
bool leave_direct(int fd) {
  const int flags = ::fcntl(fd, F_GETFL);
  return flags >= 0 && (flags & O_DIRECT) != 0 && ::fcntl(fd, F_SETFL, flags & ~O_DIRECT) == 0;
}

}  // namespace

void fail_call(ExitCode code, const char* what, const std::string& path, int error) {
  throw Error(code_of(error, code), std::string(what) + ": " + reason(error), path);
}

File File::open_read(const std::string& path) {
  if (path == "-") fail_usage("-: standard input is not supported: name an input file");
  // O_NONBLOCK: opening a pipe must not block before fstat() detects it.
  const int fd =
      retry_interrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); });
  if (fd < 0 && path.find("://") != std::string::npos)
    fail_input(path, "is a URL, which svdag does not read: download the file first");
  if (fd < 0) fail_call(ExitCode::kBadInput, "cannot be opened", path, errno);
  File file(fd, path, ExitCode::kBadInput);
  struct stat status;
  if (::fstat(fd, &status) != 0) fail_call(ExitCode::kBadInput, "cannot be examined", path, errno);
  if (S_ISDIR(status.st_mode)) fail_input(path, "is a folder: name a file in it");
  if (!S_ISREG(status.st_mode)) fail_input(path, "is not a regular file");
  return file;
}

File File::create_anonymous(const std::string& folder, const std::string& shown_as, mode_t mode) {
  const std::string& shown = shown_as.empty() ? folder : shown_as;
  int fd = retry_interrupted(
      [&] { return ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode); });
  if (fd >= 0 && can_be_named()) return File(fd, shown, ExitCode::kOutput);
  if (fd >= 0) {
    ::close(fd);
  } else if (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT) {
    fail_call(ExitCode::kOutput, "cannot write in this folder", folder, errno);
  }
  if (::access(folder.c_str(), F_OK) != 0)
    fail_call(ExitCode::kOutput, "cannot write in this folder", folder, errno);
  // Allocated before the file exists: if an allocation failed later, the file would stay.
  std::string name = folder + "/" + kTemporary + random_suffix() + ".tmp";
  File file(-1, shown, ExitCode::kOutput);
  fd = retry_interrupted([&] {
    return ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  });
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot write in this folder", folder, errno);
  file.fd_ = fd;
  file.temporary_ = std::move(name);
  return file;
}

File::File(File&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      unreadable_(other.unreadable_),
      hash_(other.hash_),
      path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})) {}

File& File::operator=(File&& other) noexcept {
  if (this != &other) {
    discard();
    fd_ = std::exchange(other.fd_, -1);
    unreadable_ = other.unreadable_;
    hash_ = other.hash_;
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
  }
  return *this;
}

File::~File() {
  discard();
}

void File::discard() noexcept {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  fd_ = -1;
}

uint64_t File::size() const {
  struct stat status;
  if (::fstat(fd_, &status) != 0) fail_call(unreadable_, "cannot be examined", path_, errno);
  return uint64_t(status.st_size);
}

size_t File::read_some_at(uint64_t offset, std::span<std::byte> out) const {
  constexpr uint64_t kMaxGap = uint64_t(1) << 16;  // that is read for the hash: a header
  if (hash_ != nullptr && offset > hash_->size() && offset - hash_->size() <= kMaxGap) {
    std::vector<std::byte> gap(size_t(offset - hash_->size()));
    read_some_at(hash_->size(), gap);
  }
  size_t done = 0;
  while (done < out.size()) {
    const ssize_t n = retry_interrupted(
        [&] { return ::pread(fd_, out.data() + done, out.size() - done, off_t(offset + done)); });
    if (n < 0 && errno == EINVAL && leave_direct(fd_)) continue;
    if (n < 0) fail_call(unreadable_, "cannot be read", path_, errno);
    if (n == 0) break;
    done += size_t(n);
  }
  if (hash_ != nullptr) hash_->add(offset, out.first(done));
  return done;
}

void File::read_at(uint64_t offset, std::span<std::byte> out) const {
  const size_t n = read_some_at(offset, out);
  if (n < out.size()) throw Error(unreadable_, "ends too early", path_, offset + n);
}

std::string File::text() const {
  std::string text(size(), '\0');
  read_at(0, std::as_writable_bytes(std::span(text)));
  return text;
}

void File::write_at(uint64_t offset, std::span<const std::byte> bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = retry_interrupted([&] {
      return ::pwrite(fd_, bytes.data() + done, bytes.size() - done, off_t(offset + done));
    });
    if (n < 0 && errno == EINVAL && leave_direct(fd_)) continue;
    if (n < 0) fail_call(ExitCode::kOutput, "cannot be written", path_, errno);
    if (n == 0) fail_call(ExitCode::kOutput, "cannot be written", path_, ENOSPC);
    done += size_t(n);
  }
}

void File::truncate(uint64_t size) {
  if (retry_interrupted([&] { return ::ftruncate(fd_, off_t(size)); }) != 0)
    fail_call(ExitCode::kOutput, "cannot be truncated", path_, errno);
}

bool File::use_direct() {
  const int flags = ::fcntl(fd_, F_GETFL);
  return flags >= 0 && ::fcntl(fd_, F_SETFL, flags | O_DIRECT) == 0;
}

bool File::try_lock() {
  if (retry_interrupted([&] { return ::flock(fd_, LOCK_EX | LOCK_NB); }) == 0) return true;
  if (errno == ENOLCK || errno == EOPNOTSUPP)
    throw Error(ExitCode::kOutput,
                "cannot be locked: choose a folder on a local disk with --scratch", path_);
  if (errno != EWOULDBLOCK) fail_call(ExitCode::kOutput, "cannot be locked", path_, errno);
  return false;
}

void File::sync() {
  if (::fsync(fd_) != 0) fail_call(ExitCode::kOutput, "cannot be synced to disk", path_, errno);
}

void File::link_as(const std::string& path) {
  if (temporary_.empty()) {
    std::string name = folder_of(path) + "/" + kTemporary + random_suffix() + ".tmp";
    const std::string self = "/proc/self/fd/" + std::to_string(fd_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) != 0)
      fail_call(ExitCode::kOutput, "cannot be created", path, errno);
    temporary_ = std::move(name);  // not a copy: if it ran out of memory, the name would stay
  }
  if (::rename(temporary_.c_str(), path.c_str()) != 0 &&
      !(errno == ENOENT && is_name_of(path, fd_)))
    fail_call(ExitCode::kOutput, "cannot be replaced", path, errno);
  temporary_.clear();
  path_ = path;
}

void File::close() {
  const int fd = std::exchange(fd_, -1);
  if (::close(fd) != 0 && errno != EINTR)
    fail_call(ExitCode::kOutput, "cannot be closed", path_, errno);
}

bool is_locked(const std::string& path) {
  try {
    const File file = File::open_read(path);
    const auto lock = [&] { return ::flock(file.descriptor(), LOCK_SH | LOCK_NB); };
    return retry_interrupted(lock) != 0 && errno == EWOULDBLOCK;
  } catch (const Error&) {
    return false;
  }
}

void sync_folder(const std::string& folder) {
  const int fd =
      retry_interrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (fd < 0) fail_call(ExitCode::kOutput, "cannot be opened", folder, errno);
  const int result = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  if (result != 0) fail_folder_sync(folder, error);
}

void fail_folder_sync(const std::string& folder, int error) {
  if (error != EINVAL && error != EOPNOTSUPP)
    fail_call(ExitCode::kOutput, "cannot be synced to disk", folder, error);
}

std::string folder_of(const std::string& path) {
  const size_t slash = path.find_last_of('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

bool begins_with(std::span<const unsigned char> magic, const std::string& path) {
  std::vector<std::byte> head(magic.size());
  return File::open_read(path).read_some_at(0, head) == head.size() &&
         std::ranges::equal(head, std::as_bytes(magic));
}

std::string base_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

bool name_exists(const std::string& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) == 0) return true;
  // Opening the folder queries the server (close-to-open consistency of NFS).
  const int folder = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return false;
  ::close(folder);
  return ::stat(path.c_str(), &status) == 0;
}

}  // namespace svdag
