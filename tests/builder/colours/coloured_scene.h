// A fixture that bakes a scene and looks up the colours of its voxels before they are encoded.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "builder/colours/colour_pass.h"
#include "builder/octree/morton.h"
#include "tests/builder/bakes.h"
#include "tests/temp_folder.h"

namespace svdag {

using Light = std::array<double, 3>;

// Linear light of a code of sRGB, and back.
inline double light(double code) {
  const double v = code / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
inline Light light(double r, double g, double b) {
  return {light(r), light(g), light(b)};
}
inline double code(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

class ColouredScene : public testing::Test {
 protected:
  // Voxels of side 1 / per_unit, with a corner at 0, each with a colour.
  void colour(const std::string& path, int per_unit, uint64_t memory = 256 * kMiB) {
    per_unit_ = per_unit;
    BuildConfig config = config_for(path, folder_.path() + "/golden.svdag", 0);
    config.voxel_size = 1.0 / per_unit;
    config.origin = Point(0);
    bake(config);
    const DagFile file = DagFile::open(config.output);
    k0_ = file.grid().k0;
    levels_ = file.grid().levels;
    Workspace workspace(folder_.path() + "/scratch", memory, 1);
    workspace.folder()->clear();
    const SpillSpace vertices = workspace.vertices();
    config.scene.colours = config.scene.paint = true;
    const Scene scene(config.scene, workspace.budget(), &vertices);
    SequentialExecutor executor;
    Progress progress;
    colours_.clear();
    report_ =
        colour_cubes(file, scene, {levels_}, &workspace, &executor, &progress,
                     [&](std::span<const CubeColour> entries) {
                       for (const CubeColour& e : entries)
                         colours_[{e.level, e.morton}] = {
                             e.linear[0] / 65535.0, e.linear[1] / 65535.0, e.linear[2] / 65535.0};
                     });
  }

  // The colour of the voxel that holds `p`; null: none is set.
  const Light* at(const Point& p) const {
    LatticePoint voxel;
    for (int a = 0; a < 3; ++a) voxel[a] = int64_t(std::floor(p[a] * per_unit_)) - k0_[a];
    for (int level = levels_; level >= 0; --level) {
      const int up = levels_ - level;
      const auto found =
          colours_.find({level, morton({voxel.x >> up, voxel.y >> up, voxel.z >> up})});
      if (found != colours_.end()) return &found->second;
    }
    return nullptr;
  }

  void expect(const Point& p, const Light& expected, double steps) const {
    const Light* const own = at(p);
    ASSERT_NE(own, nullptr) << p.x << " " << p.y << " " << p.z;
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(code((*own)[c]), code(expected[c]), steps)
          << p.x << " " << p.y << " " << p.z << ", channel " << c;
  }

  // Calls visit(x, y, centre) for the voxels that a unit square at `low` covers, but for those at
  // its border; x and y: of their centres in the square.
  void in_square(const Point& low, const std::function<void(double, double, const Point&)>& visit) {
    const int n = per_unit_;
    for (int i = 1; i + 1 < n; ++i) {
      for (int j = 1; j + 1 < n; ++j) {
        const double x = (i + 0.5) / n, y = (j + 0.5) / n;
        visit(x, y, low + Point(x, y, 0.5 / n));
      }
    }
  }

  uint64_t omissions(Omission kind) const { return report_.scene.left_out[size_t(kind)]; }

  TempFolder folder_;
  int per_unit_ = 1, levels_ = 0;
  LatticePoint k0_{0};
  std::map<std::pair<int, uint64_t>, Light> colours_;  // by level and Morton code
  ColourPassReport report_;
};

}  // namespace svdag
