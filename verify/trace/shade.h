// From what a camera ray met to a colour.
#pragma once

#include "verify/trace/kernel/workload.h"

namespace svdag {

// primary   lit by a sun without shadows, and a sky
// shadow    with the shadow of a point light
// soft      with the shadow of a ball of light
// ao        grey: the part of the sky that a point sees
// normal    directions as colours
// depth     near white, far black
// level     the level at which rays end that stop at cubes the size of a pixel
// steps     how many cubes a ray left behind, black over red and yellow to white
enum class ShadeMode { kPrimary, kShadow, kSoft, kAo, kNormal, kDepth, kLevel, kSteps };

// What is the same for every ray of a picture.
struct Shading {
  ShadeMode mode = ShadeMode::kPrimary;
  Vec3 up{};  // of the world
  Light light;
  Secondary secondary;
  Cut primary;                // of camera rays
  double near = 0;            // kDepth: white at this distance ...
  double far = 1;             // ... black at this one
  uint32_t levels = 0;        // of the DAG
  uint32_t most_steps = 128;  // kSteps: white at this number

  bool linear() const { return mode <= ShadeMode::kAo; }  // colours are light, not data
};

// Distances for the box seen, and a light over the left shoulder of the camera.
Shading make_shading(ShadeMode mode, const Camera& camera, int up, const VoxelBounds& box);

// `seen`: the part of the light, or of the sky, that the surface sees (0 .. 1).
Vec3 shade(const Shading& shading, const Ray& ray, const Hit& hit, const Surfel& surfel,
           double seen);

}  // namespace svdag
