// The share of one triangle in the colour of one cube, beside areas and means computed otherwise.
#include "builder/colours/cube_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace svdag {
namespace {

constexpr int kSideLog2 = 10;
constexpr double kSide = 1 << kSideLog2;

std::mt19937_64 engine(5);

int64_t whole(int64_t low, int64_t high) {
  return std::uniform_int_distribution<int64_t>(low, high)(engine);
}
double uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

Paint noise(int64_t width, int64_t height, double opaque = 1) {
  std::vector<uint8_t> rgba;
  for (int64_t i = 0; i < width * height; ++i) {
    for (int c = 0; c < 3; ++c) rgba.push_back(uint8_t(whole(0, 255)));
    rgba.push_back(uniform(0, 1) < opaque ? 255 : 0);
  }
  Paint paint;
  paint.image = std::make_shared<LinearImage>(width, height, rgba, 128);
  return paint;
}

PaintedTriangle random_triangle(double size) {
  PaintedTriangle t;
  t.paint = 0;
  const double at[3] = {uniform(0, kSide), uniform(0, kSide), uniform(0, kSide)};
  for (auto& corner : t.corners) {
    for (int a = 0; a < 3; ++a) corner.position[a] = int64_t(at[a] + uniform(-size, size) * kSide);
    for (uint16_t& c : corner.colour) c = uint16_t(whole(0, kWhite16));
  }
  return t;
}

struct Inside {
  double area = 0;                 // in faces
  std::array<double, 3> centre{};  // weights of the corners
};

// Clipped by the six planes of the cube in space, corners by their weights.
Inside clipped(const PaintedTriangle& t) {
  using Weights = std::array<double, 3>;
  const auto at = [&](const Weights& w, int a) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += w[k] * double(t.corners[k].position[a]) / kSide;
    return sum;
  };
  std::vector<Weights> polygon = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int plane = 0; plane < 6; ++plane) {
    const int a = plane / 2;
    const auto inner = [&](const Weights& w) { return plane % 2 == 0 ? at(w, a) : 1 - at(w, a); };
    std::vector<Weights> next;
    for (size_t k = 0; k < polygon.size(); ++k) {
      const Weights &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      if (inner(p) >= 0) next.push_back(p);
      if ((inner(p) >= 0) == (inner(q) >= 0)) continue;
      const double part = inner(p) / (inner(p) - inner(q));
      Weights r;
      for (size_t c = 0; c < 3; ++c) r[c] = p[c] + (q[c] - p[c]) * part;
      next.push_back(r);
    }
    polygon = next;
  }
  Inside inside;
  for (size_t k = 1; k + 1 < polygon.size(); ++k) {
    double e[2][3];
    for (int a = 0; a < 3; ++a) {
      e[0][a] = at(polygon[k], a) - at(polygon[0], a);
      e[1][a] = at(polygon[k + 1], a) - at(polygon[0], a);
    }
    const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1],
                         e[0][2] * e[1][0] - e[0][0] * e[1][2],
                         e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    const double part = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    inside.area += part;
    for (size_t c = 0; c < 3; ++c)
      inside.centre[c] += part * (polygon[0][c] + polygon[k][c] + polygon[k + 1][c]) / 3;
  }
  for (double& w : inside.centre) w /= inside.area > 0 ? inside.area : 1;
  return inside;
}

CubeShare share_of(PaintedTriangle t, const Paints& paints) {
  sort_corners(&t);
  const TriangleSetup setup = make_setup(t.triangle());
  return ShareSetup(t, setup, paints, kSideLog2).share_in(LatticePoint(0));
}

TEST(CubeShare, TheAreaIsThatOfTheTriangleInTheCube) {
  const Paints paints = {Paint()};
  for (int k = 0; k < 20000; ++k) {
    const PaintedTriangle t = random_triangle(k % 2 == 0 ? 0.3 : 4);
    const CubeShare share = share_of(t, paints);
    EXPECT_NEAR(std::ldexp(double(share.area), -kAreaBits), clipped(t).area, 1e-9);
  }
}

TEST(CubeShare, ColoursOfCornersGiveThatOfTheCentroid) {
  const Paints paints = {Paint()};
  int tested = 0;
  for (int k = 0; k < 20000; ++k) {
    const PaintedTriangle t = random_triangle(k % 2 == 0 ? 0.3 : 4);
    const Inside inside = clipped(t);
    if (inside.area < 1e-4) continue;
    const CubeShare share = share_of(t, paints);
    ++tested;
    for (size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (size_t i = 0; i < 3; ++i) mean += inside.centre[i] * t.corners[i].colour[c];
      EXPECT_NEAR(share.colour[c], mean, 2);
    }
  }
  EXPECT_GT(tested, 5000);
}

// Texels of a ramp: the bilinear mean is linear between the centres of the outer ones.
TEST(CubeShare, ARampOfTexelsGivesTheColourOfTheCentroid) {
  Paint ramp;
  std::vector<uint8_t> rgba;
  for (int i = 0; i < 16; ++i) rgba.push_back(i % 4 == 3 ? 255 : 0);
  rgba[4] = rgba[9] = rgba[12] = rgba[13] = 255;
  ramp.image = std::make_shared<LinearImage>(2, 2, rgba, 0);
  ramp.factor = {0.5, 1, 1};
  const Paints paints = {ramp};
  for (int k = 0; k < 20000; ++k) {
    PaintedTriangle t = random_triangle(k % 2 == 0 ? 0.3 : 4);
    for (auto& corner : t.corners) {
      corner.colour = {kWhite16, kWhite16, kWhite16};
      corner.texture = {uniform(0.5, 1.5), uniform(0.5, 1.5)};
    }
    const Inside inside = clipped(t);
    if (inside.area < 1e-4) continue;
    double u = 0, v = 0;
    for (size_t i = 0; i < 3; ++i) {
      u += inside.centre[i] * t.corners[i].texture.u;
      v += inside.centre[i] * t.corners[i].texture.v;
    }
    const CubeShare share = share_of(t, paints);
    EXPECT_NEAR(share.colour[0], (u - 0.5) * kWhite16 / 2, 2);
    EXPECT_NEAR(share.colour[1], (v - 0.5) * kWhite16, 2);
    EXPECT_EQ(share.colour[2], 0);
  }
}

TEST(CubeShare, NeitherOrderNorWindingMatter) {
  const Paints paints = {noise(9, 5, 0.7), noise(16, 16)};
  for (int k = 0; k < 3000; ++k) {
    PaintedTriangle t = random_triangle(k % 3 == 0 ? 0.2 : 3);
    t.paint = uint32_t(k % 2);
    for (auto& corner : t.corners) corner.texture = {uniform(-9, 30), uniform(-9, 30)};
    const CubeShare share = share_of(t, paints);
    for (int turn = 0; turn < 5; ++turn) {
      std::shuffle(t.corners.begin(), t.corners.end(), engine);
      const CubeShare other = share_of(t, paints);
      EXPECT_EQ(other.area, share.area);
      EXPECT_EQ(other.colour, share.colour);
    }
  }
}

TEST(CubeShare, ASquareOnTheFaceHasItsTexel) {
  Paint squares = noise(8, 8);
  squares.nearest = true;
  const Paints paints = {squares};
  for (int64_t i = 0; i < 8; ++i) {
    for (const double sign : {1.0, -1.0}) {
      PaintedTriangle t;
      t.paint = 0;
      t.corners[0].position = {int64_t(kSide), -2 * int64_t(kSide), -3 * int64_t(kSide)};
      t.corners[1].position = {int64_t(kSide), 6 * int64_t(kSide), -3 * int64_t(kSide)};
      t.corners[2].position = {int64_t(kSide), -2 * int64_t(kSide), 5 * int64_t(kSide)};
      t.corners[0].texture = {double(i), 2};
      t.corners[1].texture = {double(i) + sign * 8, 2};
      t.corners[2].texture = {double(i), 10};
      const CubeShare share = share_of(t, paints);
      EXPECT_EQ(share.area, uint64_t(1) << kAreaBits);
      const int64_t column = wrapped(sign > 0 ? i + 2 : i - 3, 8, Wrap::kRepeat);
      const LinearImage::Texel& texel = squares.image->levels()[0].at(column, 5);
      for (size_t c = 0; c < 3; ++c) EXPECT_EQ(share.colour[c], texel[c]);
    }
  }
}

// However the texels lie in the cube: as the mean of a quarter of a million points.
TEST(CubeShare, SquaresWeighTheirAreas) {
  Paint squares = noise(8, 8);
  squares.nearest = true;
  const auto& finest = squares.image->levels()[0];
  const int64_t side = int64_t(kSide);
  for (int k = 0; k < 40; ++k) {
    const double texels = uniform(0.3, 1.95), angle = uniform(0, 6.28);
    const double u0 = uniform(0, 8), v0 = uniform(0, 8);
    const double by_x = texels * std::cos(angle), by_y = texels * std::sin(angle);
    const auto at = [&](double x, double y) {
      return TexturePoint{u0 + by_x * x - by_y * y, v0 + by_y * x + by_x * y};
    };
    PaintedTriangle t;
    t.paint = 0;
    t.corners[0].position = {-2 * side, -2 * side, side / 2};
    t.corners[1].position = {6 * side, -2 * side, side / 2};
    t.corners[2].position = {-2 * side, 6 * side, side / 2};
    t.corners[0].texture = at(-2, -2);
    t.corners[1].texture = at(6, -2);
    t.corners[2].texture = at(-2, 6);
    constexpr int kPoints = 512;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < kPoints * kPoints; ++i) {
      const TexturePoint p = at((i % kPoints + 0.5) / kPoints, (i / kPoints + 0.5) / kPoints);
      const LinearImage::Texel& texel =
          finest.at(wrapped(int64_t(std::floor(p.u)), 8, Wrap::kRepeat),
                    wrapped(int64_t(std::floor(p.v)), 8, Wrap::kRepeat));
      for (size_t c = 0; c < 3; ++c) sum[c] += texel[c];
    }
    const CubeShare share = share_of(t, {squares});
    EXPECT_EQ(share.area, uint64_t(1) << kAreaBits);
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(share.colour[c], sum[c] / (kPoints * kPoints), 0.005 * kWhite16) << texels;
  }
}

TEST(CubeShare, WhatIsCutOutWeighsNothing) {
  // Columns: opaque green, transparent magenta.
  const std::array<uint8_t, 8> columns = {0, 255, 0, 255, 255, 0, 255, 10};
  std::vector<uint8_t> rgba;
  for (size_t i = 0; i < 64; ++i) rgba.push_back(columns[i % 8]);
  for (const double texels : {0.5, 2.0, 7.0, 40.0, 1000.0}) {
    Paint paint;
    paint.image = std::make_shared<LinearImage>(4, 4, rgba, 128);
    PaintedTriangle t;
    t.paint = 0;
    t.corners[1].position = {int64_t(kSide), 0, 0};
    t.corners[2].position = {0, int64_t(kSide), 0};
    t.corners[1].texture = {texels, 0};
    t.corners[2].texture = {0, texels};
    const CubeShare share = share_of(t, {paint});
    EXPECT_GT(share.area, 0u);
    EXPECT_LE(share.area, uint64_t(1) << (kAreaBits - 1));
    EXPECT_EQ(share.colour[0], 0);
    EXPECT_EQ(share.colour[1], kWhite16);
    EXPECT_EQ(share.colour[2], 0);
    if (texels >= 7) {
      EXPECT_NEAR(std::ldexp(double(share.area), 2 - kAreaBits), 1, 0.2);
    }
  }
}

// A sliver's gradients are huge, but it has no other texels than those between its corners.
TEST(CubeShare, ASliverHasTheColoursOfItsCornersOnly) {
  std::vector<uint8_t> rgba;  // the left half is red, the right one blue
  for (size_t i = 0; i < 256; ++i) {
    const bool left = i / 4 % 8 < 4;
    rgba.push_back(i % 4 == 3 || i % 4 == (left ? 0 : 2) ? 255 : 0);
  }
  Paint paint;
  paint.image = std::make_shared<LinearImage>(8, 8, rgba, 0);
  int tested = 0;
  for (int k = 0; k < 1000; ++k) {
    PaintedTriangle t = random_triangle(0.5);
    t.paint = 0;
    for (int a = 0; a < 3; ++a)
      t.corners[2].position[a] = t.corners[0].position[a] + (a == k % 3 ? 1 : 0);
    for (auto& corner : t.corners) {
      corner.texture = {uniform(1, 3), uniform(0, 8)};
      corner.colour = {kWhite16, kWhite16, kWhite16};
    }
    const CubeShare share = share_of(t, {paint});
    if (share.area == 0) continue;
    ++tested;
    EXPECT_EQ(share.colour[0], kWhite16);
    EXPECT_EQ(share.colour[2], 0);
  }
  EXPECT_GT(tested, 300);
}

TEST(CubeShare, WithoutAreaTheNearestPointHasTheColour) {
  PaintedTriangle t;
  t.paint = 0;
  t.corners[1].position = {4 * int64_t(kSide), 0, 0};
  t.corners[2].position = {2 * int64_t(kSide), 0, 0};
  t.corners[0].colour = {0, 0, 0};
  t.corners[1].colour = {kWhite16, 0, kWhite16};
  t.corners[2].colour = {kWhite16 / 2, 0, kWhite16 / 2};
  sort_corners(&t);
  const Paints paints = {Paint()};
  const TriangleSetup setup = make_setup(t.triangle());
  const ShareSetup shares(t, setup, paints, kSideLog2);
  EXPECT_EQ(shares.share_in(LatticePoint(0)).area, 0u);
  const CubeShare share = shares.nearest_to_centre({int64_t(kSide), 0, 0});
  EXPECT_NEAR(share.colour[0], kWhite16 * 3 / 8, 1);  // at 1.5 sides of 4
  EXPECT_EQ(share.colour[1], 0);
}

}  // namespace
}  // namespace svdag
