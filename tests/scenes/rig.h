// The skeleton of an animated scene: joints at rest, and how they turn in one period.
//
// At rest no joint is turned, so a joint's inverse bind matrix is the translation by its position.
#pragma once

#include <array>
#include <vector>

#include "io/triangle.h"

namespace svdag::scenes {

using Quaternion = std::array<double, 4>;  // x, y, z, w

struct Joint {
  const char* name;
  size_t parent;                  // an earlier joint; the first one is its own
  Point at;                       // at rest, in the world
  std::vector<Quaternion> turns;  // one per time
};

struct Rig {
  const char* animation;
  std::vector<double> times;  // seconds; rotations are interpolated between them
  std::vector<Joint> joints;
};

}  // namespace svdag::scenes
