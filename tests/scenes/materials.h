// The materials that a scene can have in a glTF file.
#pragma once

#include <array>
#include <string>

#include "tests/scenes/textures.h"

namespace svdag::scenes {

enum class Chart { kWhole, kAlong };  // Charts of tests/scenes/mesh.h
// Of glTF.
enum class Wrapping { kClamp = 33071, kMirror = 33648, kRepeat = 10497 };

struct Material {
  const char* name;
  std::array<double, 3> factor{1, 1, 1};  // linear light
  const Texture* texture = nullptr;
  Chart chart = Chart::kAlong;
  double metres = 1;  // of an image, if along
  Wrapping wrapping = Wrapping::kRepeat;
  int set = 0;          // TEXCOORD_n; the other chart is set 0 if this is 1
  bool tinted = false;  // has colours of vertices
};

// Null if there is none of the name.
const Material* find_material(const std::string& name);

}  // namespace svdag::scenes
