#include "streaming/spill/scratch_dir.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/file/file_lock.h"

namespace svdag {
namespace {

constexpr const char* kOwner = "owner";
constexpr const char* kEnding = ".scratch";
constexpr size_t kLongestName = 255;  // bytes, of Linux's file systems

std::string name_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

// At most `most` bytes of `name`, which do not end within a character of UTF-8.
std::string shortened(const std::string& name, size_t most) {
  if (name.size() <= most) return name;
  while (most > 0 && (name[most] & 0xC0) == 0x80) --most;
  return name.substr(0, most);
}

// The lock is the first file that an owner creates and the last that it removes, except for the
// probe of file ownership.
bool holds_others_only(const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), kOwner) != names.end()) return false;
  return !std::all_of(names.begin(), names.end(),
                      [](const std::string& name) { return name.starts_with(Folder::kProbe); });
}

}  // namespace

std::string ScratchDir::path_for(const std::string& output, const std::string& under) {
  const std::string name = name_of(output);
  if (under.empty() && (name + kEnding).size() <= kLongestName) return output + kEnding;
  const std::string absolute = absolute_path(output);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(checksum64(std::as_bytes(std::span(absolute)))));
  const std::string ending = std::string("-") + hash + kEnding;
  const std::string folder = output.substr(0, output.size() - name.size());
  return (under.empty() ? folder : under + "/") + shortened(name, kLongestName - ending.size()) +
         ending;
}

bool ScratchDir::in_use(const std::string& path) {
  return is_locked(path + "/" + kOwner);
}

ScratchDir::ScratchDir(const std::string& path) : folder_(own(path, &owner_)) {}

// A lock counts only if the locked file still has its name: between open and lock the former owner
// may have removed file and folder, and another process created new ones. A killed owner may take a
// moment to exit.
Folder ScratchDir::own(const std::string& path, File* owner) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    Folder folder = Folder::open_private(path);
    if (!folder.made() && holds_others_only(folder.names()))
      throw Error(ExitCode::kOutput, "holds other files and is not a scratch folder: move it away",
                  path);
    try {
      File file = folder.open_or_create(kOwner);
      if (file.descriptor() < 0) continue;
      if (!file.try_lock()) {
        if (std::chrono::steady_clock::now() > patience) throw ScratchInUse(path);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        continue;
      }
      if (!folder.holds(file, kOwner)) continue;
      if (folder.made()) folder.sync();  // the lock's name is on the disk before any other's
      *owner = std::move(file);
    } catch (const std::exception& error) {
      const bool in_use = dynamic_cast<const ScratchInUse*>(&error) != nullptr;
      if (folder.made() && !in_use) remove_lock(folder);
      throw;
    }
    return folder;
  }
}

// False if it failed: what is left behind the next bake of this output takes over.
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
  bool gone = true;
  for (const std::string& name : names) gone &= attempt([&] { folder.remove(name); });
  if (!names.empty()) attempt([&] { folder.sync(); });
  return gone;
}

// The lock is removed last, on disk as well: as long as `owner` has its name no other process takes
// the folder over, files without it count as foreign, and afterwards only an empty folder is
// removed.
void ScratchDir::remove_lock(const Folder& folder) noexcept {
  attempt([&] { folder.remove(kOwner); });
  attempt([&] { folder.remove_itself(); });
}

ScratchDir::~ScratchDir() {
  if (kept_) return;
  // The names of files created here are known, without an allocation; otherwise they are listed.
  const bool listed = folder_.made() || attempt([&] { made_ = names(); });
  made_.erase(kOwner);
  // Beside a file that could not be removed the lock stays, so that it can be seen whose it is.
  if (remove_files(folder_, made_) && listed) remove_lock(folder_);
}

// A folder that was made here holds nothing else; only one that was taken over must be listed.
std::set<std::string> ScratchDir::names() const {
  std::set<std::string> names = made_;
  if (!folder_.made()) {
    for (const std::string& name : folder_.names()) names.insert(name);
  }
  names.erase(kOwner);
  return names;
}

File ScratchDir::create(const std::string& name) {
  folder_.remove(name);
  made_.insert(name);
  return folder_.create(name);
}

void ScratchDir::remove(const std::string& name) {
  folder_.remove(name);
  made_.erase(name);
}

void ScratchDir::clear() {
  for (const std::string& name : names()) remove(name);
}

}  // namespace svdag
