#include "builder/bake/scene_watch.h"

#include "streaming/error.h"

namespace svdag {

void SceneWatch::begin() {
  if (!files_.empty()) return;
  scene_.visit_files([this](const File& file) { files_.push_back({file.path(), state_of(file)}); });
}

// A file that is unchanged names the same others, so nothing but the state is looked at.
void SceneWatch::check() const {
  for (const Noted& file : files_) {
    if (state_of(File::open_read(file.path)) != file.state)
      fail_input(file.path, "has changed while it was baked: bake it when nobody writes it");
  }
}

}  // namespace svdag
