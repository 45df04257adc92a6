#include "streaming/spill/scratch_dir.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/file/file.h"

namespace svdag {
namespace {

constexpr const char* kOwner = "owner";
constexpr const char* kEnding = ".scratch";
constexpr size_t kMaxNameBytes = 255;  // of Linux's file systems

// The first `max_bytes` bytes of `name`, or fewer to end between two UTF-8 characters.
std::string shortened(const std::string& name, size_t max_bytes) {
  if (name.size() <= max_bytes) return name;
  while (max_bytes > 0 && (name[max_bytes] & 0xC0) == 0x80) --max_bytes;
  return name.substr(0, max_bytes);
}

// True if the folder has files but is not a scratch folder: an owner creates its lock first, except
// for a temporary file that shows who owns new files, and removes it last.
bool has_only_foreign_files(const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), kOwner) != names.end()) return false;
  return !std::all_of(names.begin(), names.end(),
                      [](const std::string& name) { return name.starts_with(File::kTemporary); });
}

}  // namespace

std::string ScratchDir::path_for(const std::string& output, const std::string& under) {
  const std::string name = base_name(output);
  if (under.empty() && (name + kEnding).size() <= kMaxNameBytes) return output + kEnding;
  const std::string absolute = absolute_path(output);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(checksum64(std::as_bytes(std::span(absolute)))));
  const std::string ending = std::string("-") + hash + kEnding;
  const std::string folder = output.substr(0, output.size() - name.size());
  return (under.empty() ? folder : under + "/") + shortened(name, kMaxNameBytes - ending.size()) +
         ending;
}

bool ScratchDir::in_use(const std::string& path) {
  return is_locked(path + "/" + kOwner);
}

ScratchDir::ScratchDir(const std::string& path) : folder_(acquire(path, &lock_)) {}

// A lock is valid only if the locked file still has its name: between open and lock the previous
// owner may have removed file and folder, and another process may have created new ones. Waits up
// to a second for a lock, because a killed owner may take a moment to exit.
Folder ScratchDir::acquire(const std::string& path, File* lock) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    Folder folder = Folder::open_private(path);
    if (!folder.created() && has_only_foreign_files(folder.names()))
      throw Error(ExitCode::kOutput,
                  "has other files and is not a scratch folder: move or rename it", path);
    try {
      File file = folder.open_or_create(kOwner);
      if (file.descriptor() < 0) continue;
      if (!file.try_lock()) {
        if (std::chrono::steady_clock::now() > deadline) throw ScratchInUse(path);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        continue;
      }
      if (!folder.holds(file, kOwner)) continue;
      *lock = std::move(file);
    } catch (const std::exception& error) {
      const bool in_use = dynamic_cast<const ScratchInUse*>(&error) != nullptr;
      if (folder.created() && !in_use) remove_lock(folder);
      throw;
    }
    return folder;
  }
}

// Returns false if `action` failed: the next bake of this output takes over the remaining files.
template <class Action>
bool ScratchDir::attempt(const Action& action) noexcept {
  try {
    action();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

bool ScratchDir::remove_files(const Folder& folder, const std::set<std::string>& names) noexcept {
  bool removed = true;
  for (const std::string& name : names) removed &= attempt([&] { folder.remove(name); });
  if (!names.empty()) attempt([&] { folder.sync(); });
  return removed;
}

// Called after all other files have been removed, on disk as well, because files without a lock
// count as foreign. While the lock exists no other process takes over the folder.
void ScratchDir::remove_lock(const Folder& folder) noexcept {
  attempt([&] { folder.remove(kOwner); });
  attempt([&] { folder.remove_itself(); });
}

ScratchDir::~ScratchDir() {
  if (kept_) return;
  // If the folder was created here its files are known, without an allocation.
  const bool listed = folder_.created() || attempt([&] { created_files_ = names(); });
  created_files_.erase(kOwner);
  // If a file cannot be removed the lock stays, which marks the folder as scratch.
  if (remove_files(folder_, created_files_) && listed) remove_lock(folder_);
}

// Only a folder that was taken over must be listed.
std::set<std::string> ScratchDir::names() const {
  std::set<std::string> names = created_files_;
  if (!folder_.created()) {
    for (const std::string& name : folder_.names()) names.insert(name);
  }
  names.erase(kOwner);
  return names;
}

// The lock's name is on disk before any other name. A bake without files syncs nothing.
void ScratchDir::register_file(const std::string& name) {
  if (folder_.created() && created_files_.empty()) folder_.sync();
  created_files_.insert(name);
}

File ScratchDir::create(const std::string& name) {
  folder_.remove(name);
  register_file(name);
  return folder_.create(name);
}

std::string ScratchDir::path_of(const std::string& name) {
  register_file(name);
  return path() + "/" + name;
}

void ScratchDir::remove(const std::string& name) {
  folder_.remove(name);
  created_files_.erase(name);
}

void ScratchDir::clear() {
  for (const std::string& name : names()) remove(name);
}

}  // namespace svdag
