#include "builder/bake/scene_watch.h"

#include "streaming/error.h"

namespace svdag {

void SceneWatch::begin() {
  if (!files_.empty()) return;
  scene_.visit_files([this](const File& file) { files_.push_back({file.path(), state_of(file)}); });
}

// An unchanged file refers to the same other files, so comparing the states is enough.
void SceneWatch::check() const {
  for (const Noted& file : files_) {
    if (state_of(File::open_read(file.path)) != file.state)
      fail_input(file.path, "changed during the bake: bake it when no program writes to it");
  }
}

}  // namespace svdag
