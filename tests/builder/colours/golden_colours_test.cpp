// Scenes whose colour is known at every point (SVDAG_SCENES): wraps, coordinate sets, transforms,
// factors, colours of vertices and masks, by formulas of the glTF specification.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/builder/colours/coloured_scene.h"
#include "tests/shared_scenes.h"

namespace svdag {
namespace {

class GoldenColours : public ColouredScene {
 protected:
  void colour_shared(const std::string& name, int per_unit) {
    colour(shared_scene(name), per_unit);
    EXPECT_TRUE(report_.scene.unread_images.empty());
  }
};

TEST_F(GoldenColours, ColourChart) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour_shared("colour_chart.glb", 64);
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
  colour_shared("wrap_modes.glb", 60);
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
  colour_shared("texcoord1_transform.glb", 60);
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
