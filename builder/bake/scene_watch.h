// Whether the files of a scene stay as they are while it is baked.
//
// A bake reads them more than once: for the box, the triangles, the hash. Were one rewritten in
// between, the triangles would be of two scenes, or the journal would name another content than
// the triangles have, and a resumed bake would trust it. So what stat says of every file is noted
// before the first reading, and compared after the last one that gives triangles and after the
// hash, which follows at once where a report wants it. Rejected: copies and locks (nobody else
// keeps to them), the hash before and after (a reading more).
#pragma once

#include <string>
#include <vector>

#include "io/scene/scene.h"
#include "streaming/file/file_state.h"

namespace svdag {

class SceneWatch {
 public:
  explicit SceneWatch(const Scene& scene) : scene_(scene) {}

  // Notes the files as they are now, those that they name included; once.
  void begin();
  // An Error (kBadInput) that names a file which is not as it was.
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
