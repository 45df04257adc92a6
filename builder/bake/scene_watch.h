// Detects changes of a scene's files during a bake.
//
// A bake reads them more than once: for the box, the triangles, the hash. If one changed in
// between, triangles of two scenes could be mixed, or the journal could name content that the
// triangles do not have, and a resumed bake would trust it. So the state of every file is recorded
// before the first read, and compared after the triangles were read and after the hash, which is
// computed at once if a report needs it. Rejected: copies, locks (other programs ignore them),
// hashing before and after (one more read).
#pragma once

#include <string>
#include <vector>

#include "io/scene/scene.h"
#include "streaming/file/file_state.h"

namespace svdag {

class SceneWatch {
 public:
  explicit SceneWatch(const Scene& scene) : scene_(scene) {}

  // Records the state of the files, including those that they refer to; once.
  void begin();
  // Error (kBadInput) that names the first changed file.
  void check() const;

 private:
  struct Noted {
    std::string path;
    FileState state;
  };

  const Scene& scene_;
  std::vector<Noted> files_;
};

}  // namespace svdag
