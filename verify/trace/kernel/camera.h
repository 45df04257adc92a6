// A pinhole camera in voxel coordinates.
#pragma once

#include <array>

#include "verify/trace/kernel/vector.h"

namespace svdag {

struct VoxelBounds {
  Vec3 min{{0, 0, 0}};
  Vec3 max{{0, 0, 0}};
};

std::array<Vec3, 8> corners_of(const VoxelBounds& box);

struct Camera {
  static constexpr double kDefaultFov = 40;  // degrees, vertical

  Vec3 position;
  Vec3 right, up, forward;  // orthonormal
  double slope;             // tangent of half the vertical angle of view
  double aspect;            // width / height

  // The ray through image position (x, y), both 0 .. 1 from the upper left corner; its direction
  // has length 1.
  SVDAG_HD Ray ray(double x, double y) const {
    const double h = (2 * x - 1) * slope * aspect, v = (1 - 2 * y) * slope;
    return {position, normalized(forward + right * h + up * v)};
  }
};

// From `position` towards `target`; `up` is an axis (0 .. 2) of the world.
Camera look_at(const Vec3& position, const Vec3& target, int up, double fov, double aspect);

// Looks at the middle of `box` from the direction `towards`, just far enough to see all of it.
Camera frame_box(const VoxelBounds& box, const Vec3& towards, int up, double fov, double aspect);

// Looks in the same direction and fills the picture with what is set in `box`, to 1/128 of its
// longest side; with the box itself if the DAG is empty.
Camera frame_voxels(const DagView& dag, const VoxelBounds& box, const Vec3& towards, int up,
                    double fov, double aspect);

// `box`, grown to the bounds of the set voxels, rounded outwards to 1/256 of the grid or to bricks,
// whichever is larger: precise enough to frame a picture.
VoxelBounds framing_bounds(const DagView& dag, VoxelBounds box = {});

}  // namespace svdag
