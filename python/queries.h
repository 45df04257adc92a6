// Queries of the Python module: windows, lists, points, boxes, rays and colours, on many threads.
//
// All functions check for interrupts at least ten times a second. Coordinates are in voxels of the
// requested level, and may be outside of the grid.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io/dag/colours/dag_colours.h"
#include "io/dag/walk/cube_walk.h"
#include "streaming/process/executor.h"
#include "verify/trace/kernel/rays.h"

namespace svdag {

// Sets out[((x - min.x) * ny + y - min.y) * nz + z - min.z] to 1 for each set voxel of level
// `level` in `box`; `out` is zero before.
void fill_window(const DagView& dag, uint32_t level, const VoxelBox& box, uint8_t* out,
                 Executor* executor);

// The set voxels of level `level` in `box`, in Morton order.
std::vector<std::array<int32_t, 3>> list_voxels(const DagView& dag, uint32_t level,
                                                const VoxelBox& box);

// Those of the voxels (level L) whose closed cubes are within `radius` of `center`.
std::vector<std::array<int32_t, 3>> list_ball(const DagView& dag, const Vec3& center,
                                              double radius);

// A brick of 4^3 voxels; its corner is a multiple of 4.
struct PlacedBrick {
  std::array<int32_t, 3> corner;
  Brick brick;
};
// The next bricks in `box` in Morton order, from the one that is number `first` of the grid's
// (Morton code of its corner / 64) on: at most `count`. Bricks are whole, also at the box's faces.
std::vector<PlacedBrick> next_bricks(const DagView& dag, const VoxelBox& box, uint64_t first,
                                     size_t count);

// set[i] is 1 if the voxel that holds points[i] is set.
void look_up(const DagView& dag, std::span<const std::array<int64_t, 3>> points, uint8_t* set,
             Executor* executor);
// The same for points of the world.
void look_up(const DagView& dag, std::span<const std::array<double, 3>> points, uint8_t* set,
             Executor* executor);

using Rgb = std::array<uint8_t, 3>;
// out[i] gets the colour of the cube of level `level` that holds points[i]. It keeps its value
// where the cube has no set voxel, or no colour.
void look_up_colours(const ColourView& colours, uint32_t level,
                     std::span<const std::array<int64_t, 3>> points, Rgb* out, Executor* executor);
// The same for points of the world.
void look_up_colours(const ColourView& colours, uint32_t level,
                     std::span<const std::array<double, 3>> points, Rgb* out, Executor* executor);
// The same for all cubes of level `level` in `box`, in the order of fill_window().
void fill_window_colours(const DagColours& colours, uint32_t level, const VoxelBox& box, Rgb* out,
                         Executor* executor);

// The voxels nearest to points (io/dag/walk/nearest.h), and the distances in world units. -1 and
// infinite where there is none within `max_distance`. A point of integers is the middle of a voxel.
void find_nearest(const DagView& dag, std::span<const std::array<int64_t, 3>> points,
                  double max_distance, std::array<int32_t, 3>* voxels, double* distances,
                  Executor* executor);
// The same for points of the world.
void find_nearest(const DagView& dag, std::span<const std::array<double, 3>> points,
                  double max_distance, std::array<int32_t, 3>* voxels, double* distances,
                  Executor* executor);

// Whether a voxel of `box` is set.
bool any_in_box(const DagView& dag, const VoxelBox& box);
// Traces `count` rays in pieces: make(first, rays) makes those from number `first` on, take(first,
// hits) takes what they hit. Both are called by several threads.
void trace_rays(const DagView& dag, size_t count, double t_max,
                const std::function<void(size_t first, std::span<Ray> rays)>& make,
                const std::function<void(size_t first, std::span<const Hit> hits)>& take,
                Executor* executor);

}  // namespace svdag
