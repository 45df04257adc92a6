// Scenes with known colours for tests of the judge of colours, and what is planted in them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/builder/colours/painted_scene.h"

namespace svdag {

// A texture of 64 x 64 texels in 4 x 4 charts, whose colours all differ and change smoothly inside.
struct ChartTexture {
  static constexpr int kSide = 64, kChart = 16;
  std::function<std::array<int, 4>(int i, int j)> texel = [](int i, int j) {
    const int a = i / kChart, b = j / kChart;
    return std::array<int, 4>{20 + 60 * a + 3 * (i % kChart), 20 + 60 * b + 3 * (j % kChart),
                              40 * ((a + b) % 4) + 4 * (i % kChart) + 20, 255};
  };

  std::string bytes() const {
    std::string rgba;
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        for (const int value : texel(i, j)) rgba += char(value);
      }
    }
    return rgba;
  }
};

// A square in chart (a, b), whose borders of `margin` texels it leaves out; `moved`, in texels.
inline std::vector<TestTriangle> chart_square(const Point& corner, const Point& u, const Point& v,
                                              int a, int b, double margin = 1, double moved = 0) {
  const double size = ChartTexture::kSide, chart = ChartTexture::kChart;
  const auto at = [&](int i, int j) {
    const double x = a * chart + (i == 0 ? margin : chart - margin) + moved;
    const double y = b * chart + (j == 0 ? margin : chart - margin);
    return std::array<float, 2>{float(x / size), float(y / size)};
  };
  const Point p[4] = {corner, corner + u, corner + u + v, corner + v};
  const std::array<float, 2> t[4] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
  std::vector<TestTriangle> both(2);
  both[0].triangle = {{p[0], p[1], p[2]}};
  both[0].texture = {t[0], t[1], t[2]};
  both[1].triangle = {{p[0], p[2], p[3]}};
  both[1].texture = {t[0], t[2], t[3]};
  return both;
}

// Six squares around a slanted block, each in a chart of its own.
inline std::vector<TestTriangle> chart_block(double margin = 1, double moved = 0) {
  const Point o(0.1, 0.2, 0.05), x(1, 0.13, 0.05), y(-0.11, 1, 0.07), z(0.02, -0.06, 0.8);
  std::vector<TestTriangle> all;
  const auto add = [&](const Point& corner, const Point& u, const Point& v, int a, int b) {
    const auto square = chart_square(corner, u, v, a, b, margin, moved);
    all.insert(all.end(), square.begin(), square.end());
  };
  add(o, x, y, 0, 0);
  add(o + z, x, y, 1, 0);
  add(o, y, z, 2, 1);
  add(o + x, y, z, 3, 1);
  add(o, z, x, 0, 2);
  add(o + y, z, x, 1, 3);
  return all;
}

struct BlockScene {
  std::array<double, 3> factor{1, 1, 1};
  ChartTexture texture;
  bool is_textured = true, has_colours = false, is_masked = false;
  double margin = 1, moved = 0;
  nlohmann::json sampler = nlohmann::json::object();

  std::string glb() const {
    PaintedGlb glb;
    const int image = is_textured ? glb.texture(ChartTexture::kSide, ChartTexture::kSide,
                                                texture.bytes(), sampler)
                                  : -1;
    std::vector<TestTriangle> triangles = chart_block(margin, moved);
    for (TestTriangle& t : triangles) {
      for (size_t k = 0; has_colours && k < 3; ++k) {
        const Point& p = t.triangle.v[k];
        for (int c = 0; c < 3; ++c) t.colour[k][size_t(c)] = float(0.4 + 0.4 * p[c]);
      }
    }
    nlohmann::json material = glb.material(factor, image);
    if (is_masked) material["alphaMode"] = "MASK";
    glb.add(material, triangles, has_colours);
    return glb.bytes();
  }
};

}  // namespace svdag
