// The kinds of scenes that svdag-scene makes, each with about `triangles` triangles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/scenes/mesh.h"

namespace svdag::scenes {

// A building around a court: two storeys of round arches, columns, tiled floor, curtains, plants.
std::unique_ptr<Mesh> make_atrium(uint64_t triangles, uint64_t seed);
// A person with a skeleton who walks, if written as a GLB.
std::unique_ptr<Mesh> make_figure(uint64_t triangles, uint64_t seed);
// Thin tubes from the centre of a sphere to its surface: much surface, hardly any flat part.
std::unique_ptr<Mesh> make_hairball(uint64_t triangles, uint64_t seed);
// A closed, displaced sphere without any flat part, like the scan of a sculpture.
std::unique_ptr<Mesh> make_scan(uint64_t triangles, uint64_t seed);
// Boxes of 12 triangles on a ground plate; axis-aligned unless rotated.
std::unique_ptr<Mesh> make_city(uint64_t triangles, uint64_t seed);
// A heightfield.
std::unique_ptr<Mesh> make_terrain(uint64_t triangles, uint64_t seed);
// One tilted rectangle of two triangles: the largest triangles there are.
std::unique_ptr<Mesh> make_rectangle(uint64_t triangles, uint64_t seed);
// One square of two triangles, tilted against all axes so that no part of it repeats another.
std::unique_ptr<Mesh> make_sheet(uint64_t triangles, uint64_t seed);
// A soup within one millionth of its box: more triangles in a voxel than fit in memory.
std::unique_ptr<Mesh> make_speck(uint64_t triangles, uint64_t seed);

struct Kind {
  const char* name;
  uint64_t default_triangles;
  std::unique_ptr<Mesh> (*make)(uint64_t triangles, uint64_t seed);
};
const std::vector<Kind>& kinds();

// The kind called `name`; an unknown name or an impossible count is an Error (kUsage).
// `triangles` = 0 takes the kind's default.
std::unique_ptr<Mesh> make_scene(const std::string& name, uint64_t triangles, uint64_t seed);

}  // namespace svdag::scenes
