#include "streaming/scratch_dir.h"

#include <cstdio>

#include "streaming/checksum.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr const char* kOwner = "owner";

std::string name_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

}  // namespace

std::string ScratchDir::path_for(const std::string& output, const std::string& under) {
  if (under.empty()) return output + ".scratch";
  const std::string absolute = absolute_path(output);
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx",
                static_cast<unsigned long long>(checksum64(std::as_bytes(std::span(absolute)))));
  return under + "/" + name_of(output) + "-" + hash + ".scratch";
}

ScratchDir::ScratchDir(const std::string& path) : folder_(own(path, &owner_)) {}

// A lock counts only if the locked file still has its name: between open and lock the former owner
// may have removed file and folder, and somebody else made new ones.
Folder ScratchDir::own(const std::string& path, File* owner) {
  for (;;) {
    Folder folder = Folder::open_private(path);
    File file = folder.open_or_create(kOwner);
    if (file.descriptor() < 0) continue;
    if (!file.try_lock())
      throw Error(ExitCode::kUsage,
                  "another bake is using this scratch folder: wait for it, or end it", path);
    if (!folder.holds(file, kOwner)) continue;
    *owner = std::move(file);
    return folder;
  }
}

// The lock goes last: as long as `owner` has its name nobody else can come in, and afterwards only
// an empty folder is removed.
ScratchDir::~ScratchDir() {
  if (kept_) return;
  try {
    for (const std::string& name : folder_.names()) {
      try {
        if (name != kOwner) folder_.remove(name);
      } catch (const Error&) {  // a folder that somebody put there
      }
    }
    folder_.remove(kOwner);
    folder_.remove_itself();
  } catch (const std::exception&) {  // left behind; the next bake of this output takes it over
  }
}

File ScratchDir::create(const std::string& name) {
  folder_.remove(name);
  return folder_.create(name);
}

void ScratchDir::clear() {
  for (const std::string& name : folder_.names()) {
    if (name != kOwner) folder_.remove(name);
  }
}

}  // namespace svdag
