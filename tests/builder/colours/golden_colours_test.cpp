// Scenes whose colour is known at every point (SVDAG_SCENES): wraps, coordinate sets, transforms,
// factors, colours of vertices and masks, by formulas of the glTF specification.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "builder/colours/colour_pass.h"
#include "builder/octree/morton.h"
#include "tests/builder/bakes.h"
#include "tests/shared_scenes.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Light = std::array<double, 3>;

double light(double code) {
  const double v = code / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
Light light(double r, double g, double b) {
  return {light(r), light(g), light(b)};
}
double code(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

class GoldenColours : public testing::Test {
 protected:
  // Voxels of side 1 / per_unit, with a corner at 0, each with a colour.
  void colour(const std::string& name, int per_unit) {
    per_unit_ = per_unit;
    BuildConfig config = config_for(shared_scene(name), folder_.path() + "/golden.svdag", 0);
    config.voxel_size = 1.0 / per_unit;
    config.origin = Point(0);
    bake(config);
    const DagFile file = DagFile::open(config.output);
    k0_ = file.grid().k0;
    levels_ = file.grid().levels;
    Workspace workspace(folder_.path() + "/scratch", 256 * kMiB, 1);
    config.scene.colours = config.scene.paint = true;
    const Scene scene(config.scene, workspace.budget());
    SequentialExecutor executor;
    Progress progress;
    report_ =
        colour_cubes(file, scene, {levels_}, &workspace, &executor, &progress,
                     [&](std::span<const CubeColour> entries) {
                       for (const CubeColour& e : entries)
                         colours_[{e.level, e.morton}] = {
                             e.linear[0] / 65535.0, e.linear[1] / 65535.0, e.linear[2] / 65535.0};
                     });
    EXPECT_TRUE(report_.scene.unread_images.empty());
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

  TempFolder folder_;
  int per_unit_ = 1, levels_ = 0;
  LatticePoint k0_{0};
  std::map<std::pair<int, uint64_t>, Light> colours_;  // by level and Morton code
  ColourPassReport report_;
};

TEST_F(GoldenColours, ColourChart) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour("colour_chart.glb", 64);
  std::ifstream in(shared_scene("colour_chart_expected.json"));
  int tested = 0;
  const nlohmann::json expected = nlohmann::json::parse(in);
  for (const auto& point : expected["points"]) {
    const auto& p = point["point"];
    Point place(p[0], p[1], p[2]);
    if (point.value("hole", false)) {
      EXPECT_EQ(at(place + Point(0, 0, 0.001)), nullptr);
      continue;
    }
    const std::string node = point["node"];
    SCOPED_TRACE(point.dump());
    // The cube outside of a face of 64 x 64 texels holds one of them, and touches no other face.
    if (point.contains("normal")) {
      const auto& n = point["normal"];
      place += 0.001 * Point(n[0], n[1], n[2]);
    }
    const auto& c = point["srgb"];
    expect(place, light(c[0], c[1], c[2]), node == "sphere" ? 4 : 0.05);
    ++tested;
  }
  EXPECT_GT(tested, 90);
  int green = 0;
  in_square(Point(4, 0, 0.5), [&](double, double, const Point& centre) {
    const Light* const own = at(centre);
    if (own == nullptr) return;
    ++green;
    expect(centre, light(40, 160, 60), 0.05);  // no magenta
  });
  EXPECT_GT(green, 1000);
}

double wrapped_column(double u, int mode) {
  const double whole = std::floor(u), part = u - whole;
  if (mode == 0) return part;
  if (mode == 1) return std::fmod(std::abs(whole), 2) == 1 ? 1 - part : part;
  return std::min(std::max(u, 0.0), 0.999999);
}

Light texel(double u, double v) {
  return light(20 + 70 * std::floor(4 * u), 20 + 70 * std::floor(4 * v), 90);
}

TEST_F(GoldenColours, WrapModes) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour("wrap_modes.glb", 60);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      in_square(Point(1.2 * column, -1.2 * row, 0), [&](double x, double y, const Point& centre) {
        const double u = wrapped_column(3 * x - 1, column);
        const double v = wrapped_column(3 * (1 - y) - 1, row);
        expect(centre, texel(u, v), 0.05);
      });
    }
  }
}

TEST_F(GoldenColours, CoordinateSetsTransformsFactorsAndColoursOfVertices) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour("texcoord1_transform.glb", 60);
  const auto square = [](int k) { return Point(1.2 * k, 0, 0); };
  const auto repeated = [](double u, double v) {
    return texel(u - std::floor(u), v - std::floor(v));
  };
  in_square(square(0), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x, 1 - y), 0.05);
  });
  // KHR_texture_transform: translation x rotation x scale; cubes within one texel.
  int tested = 0;
  in_square(square(1), [&](double x, double y, const Point& centre) {
    const double angle = M_PI / 6;
    std::map<std::pair<int, int>, Light> texels;
    for (const double dx : {-0.01, 0.01}) {
      for (const double dy : {-0.01, 0.01}) {
        const double s = 2 * (x + dx), t = 1.5 * (1 - y + dy);
        const double u = std::cos(angle) * s + std::sin(angle) * t + 0.25;
        const double v = std::cos(angle) * t - std::sin(angle) * s + 0.5;
        texels[{int(std::floor(4 * u)), int(std::floor(4 * v))}] = repeated(u, v);
      }
    }
    if (texels.size() > 1) return;
    ++tested;
    expect(centre, texels.begin()->second, 0.05);
  });
  EXPECT_GT(tested, 1500);
  in_square(square(2), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x + 0.25, 1 - y), 0.05);
  });
  for (int k = 3; k <= 5; ++k) {
    in_square(square(k), [&](double x, double y, const Point& centre) {
      // White, red, green and blue at the top left, bottom left, bottom right and top right.
      Light mix = x + y < 1 ? Light{y + (1 - x - y), y + x, y}
                            : Light{1 - x, (1 - x) + (1 - y), (1 - x) + (x + y - 1)};
      if (k == 3) {
        const Light image = repeated(x, 1 - y);
        const Light factor = {1, 0.5, 0.25};
        for (size_t c = 0; c < 3; ++c) mix[c] *= image[c] * factor[c];
      }
      expect(centre, mix, 1);
    });
  }
  in_square(square(6), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x, 1 - y), 0.05);
  });
}

}  // namespace
}  // namespace svdag
