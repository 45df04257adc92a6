// From a hit to a colour (linear light, 0 .. 1).
#pragma once

#include "verify/trace/camera.h"

namespace svdag {

// kShadow is kPrimary with the shadow that the key light casts.
enum class ShadeMode { kPrimary, kShadow, kNormal, kDepth };

// What is the same for every ray of a picture.
struct Shading {
  ShadeMode mode = ShadeMode::kPrimary;
  Vec3 up{};        // of the world
  Vec3 light{};     // unit vector towards the key light
  double near = 0;  // kDepth: white at this distance ...
  double far = 1;   // ... black at this one
};

// A key light over the left shoulder of the camera; distances from the box seen.
Shading make_shading(ShadeMode mode, const Camera& camera, int up, const VoxelBounds& box);

Vec3 shade(const Shading& shading, const DagView& dag, const Ray& ray, const Hit& hit);

}  // namespace svdag
