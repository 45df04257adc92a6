// The colour of a camera ray, by what it hits.
#pragma once

#include <array>

#include "io/colour.h"
#include "verify/trace/kernel/traverse.h"
#include "verify/trace/kernel/workload.h"

namespace svdag {

// primary   lit by a sun without shadows, and a sky
// shadow    with hard shadows of a point light
// soft      with soft shadows of a spherical light
// ao        ambient occlusion, in grey: the visible part of the sky
// normal    directions as colours
// depth     near white, far black
// level     the level at which rays end that stop at cubes the size of a pixel
// colour    as primary, in the file's colours, else each layer in its colour; shadow and soft show these, too
// steps     number of traversal steps, from black over red and yellow to white
enum class ShadeMode { kPrimary, kShadow, kSoft, kAo, kNormal, kDepth, kLevel, kSteps, kColour };

// The parameters that all rays of a picture share.
struct Shading {
  ShadeMode mode = ShadeMode::kPrimary;
  Vec3 up{};  // of the world
  Light light;
  Secondary secondary;
  Cut primary;               // of camera rays
  double near = 0, far = 1;  // kDepth: white and black at these distances, in voxels
  uint32_t levels = 0;       // of the DAG
  uint32_t max_steps = 128;  // kSteps: white at this number
  double pixel = 0;  // width of a pixel at distance 1: near voxels show their faces; 0: none does
  bool grid_lines = false;  // draw the edges of near voxels

  // Whether colours are light, not data.
  bool linear() const { return mode <= ShadeMode::kAo || mode == ShadeMode::kColour; }
  // Whether the layers of a file have their colours.
  bool shows_layers() const {
    return mode == ShadeMode::kColour || mode == ShadeMode::kShadow || mode == ShadeMode::kSoft;
  }
};

// The part of light that surfaces without a colour reflect.
constexpr Vec3 kClay{{0.50, 0.46, 0.40}};

inline Vec3 albedo_of(const Colour& colour) {
  static const std::array<double, 256> kLight = [] {
    std::array<double, 256> light;
    for (size_t code = 0; code < light.size(); ++code) light[code] = light_of(double(code));
    return light;
  }();
  return {{kLight[colour.r], kLight[colour.g], kLight[colour.b]}};
}

// The distances of `box`, and a light over the left shoulder of the camera. A camera that cannot
// see that light, in a room for example, gets a lamp near it.
Shading make_shading(ShadeMode mode, const DagView& dag, const Camera& camera, int up,
                     const VoxelBounds& box);

// The normal that a picture shows. Smooth normals are for voxels of a few pixels or less; the faces
// of larger ones are flat. Between, the two are mixed.
Vec3 shown_normal(const Shading& shading, const Ray& ray, const Hit& hit, const Vec3& smooth);

// 1, or less on the edges of a near voxel if they are drawn.
double grid_line(const Shading& shading, const Ray& ray, const Hit& hit);

// The colour of a section in pictures of light. Pictures of data show data there, too.
Vec3 section_colour(const Shading& shading, const Surfel& surfel);

// `visibility`: the part of the light, or of the sky, that is visible from the surface (0 .. 1).
// `albedo`: the part of light that the surface reflects.
Vec3 shade(const Shading& shading, const Ray& ray, const Hit& hit, const Surfel& surfel,
           double visibility, const Vec3& albedo = kClay);

}  // namespace svdag
