// The colour that the judge expects of a cube, where it is known.
#include "verify/colours/cube_estimate.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

constexpr int64_t kSide = 1024;

JudgedTriangle triangle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                        std::array<double, 3> colour = {1, 1, 1}) {
  JudgedTriangle t;
  t.corners = {a, b, c};
  t.colour = colour;
  return t;
}

struct Estimated : CubeEstimate {
  Estimated(const std::vector<JudgedTriangle>& triangles, const LatticePoint& corner) {
    Random random(1);
    for (const JudgedTriangle& t : triangles) add(t, corner, kSide, random);
  }
};

TEST(CubeEstimate, ColoursWeighByArea) {
  // Half of a face, and all of another one, of a cube that they extend beyond.
  const JudgedTriangle half = triangle({0, 0, 512}, {1024, 0, 512}, {0, 1024, 512}, {1, 0, 0.5});
  const JudgedTriangle all =
      triangle({-9000, -9000, 256}, {9000, -9000, 256}, {0, 12000, 256}, {0, 1, 0.5});
  const Estimated cube({half, all}, LatticePoint(0));
  ASSERT_TRUE(cube.has_mean());
  EXPECT_NEAR(cube.mean(0), 1.0 / 3, 1e-9);
  EXPECT_NEAR(cube.mean(1), 2.0 / 3, 1e-9);
  EXPECT_NEAR(cube.mean(2), 0.5, 1e-9);
  EXPECT_NEAR(cube.tolerance(0), 0, 1e-9);
}

TEST(CubeEstimate, ATriangleInAFaceIsInBothCubes) {
  const JudgedTriangle t = triangle({0, 0, 1024}, {1024, 0, 1024}, {0, 1024, 1024});
  EXPECT_TRUE(Estimated({t}, {0, 0, 0}).has_mean());
  EXPECT_TRUE(Estimated({t}, {0, 0, 1024}).has_mean());
  EXPECT_FALSE(Estimated({t}, {0, 0, 2048}).is_touched());
}

TEST(CubeEstimate, ACubeThatIsOnlyTouchedHasNoMean) {
  const JudgedTriangle t = triangle({0, 0, 0}, {1024, 0, 0}, {0, 0, 1024});
  const Estimated beside({t}, {1024, 0, 0});
  EXPECT_TRUE(beside.is_touched());
  EXPECT_FALSE(beside.has_mean());
  const JudgedTriangle segment = triangle({0, 0, 0}, {1000, 1000, 1000}, {500, 500, 500});
  EXPECT_TRUE(Estimated({segment}, LatticePoint(0)).is_touched());
  EXPECT_FALSE(Estimated({segment}, LatticePoint(0)).has_mean());
}

TEST(CubeEstimate, WhatIsLinearIsKnown) {
  JudgedTriangle t = triangle({-1024, -1024, 100}, {3072, -1024, 300}, {-1024, 3072, 100});
  Paint paint;
  paint.factor = {1, 0.5, 0.25};
  t.paint = &paint;
  t.corner_colours = {{{0, 0, 0}, {65535, 65535, 65535}, {0, 0, 0}}};
  const Estimated cube({t}, LatticePoint(0));
  // At the middle of the face, 1.5 of 4 sides on.
  EXPECT_NEAR(cube.mean(0), 0.375, 1e-3);
  EXPECT_NEAR(cube.mean(1), 0.375 / 2, 1e-3);
  EXPECT_NEAR(cube.mean(2), 0.375 / 4, 1e-3);
  EXPECT_LT(cube.tolerance(0), 1e-3);
}

// Two triangles of a face that share an edge, in one chart, or the second one elsewhere.
TEST(CubeEstimate, WherePartsOfTexturesThatAreNotNeighboursMeetIsASeam) {
  const JudgedTexture texture(64, 64, std::vector<uint8_t>(4 * 64 * 64, 255), 0), other = texture;
  Paint paint;
  const auto seam = [&](double moved, const JudgedTexture* second) {
    JudgedTriangle t = triangle({0, 0, 512}, {1024, 0, 512}, {0, 1024, 512});
    JudgedTriangle u = triangle({1024, 0, 512}, {1024, 1024, 512}, {0, 1024, 512});
    t.paint = u.paint = &paint;
    t.texture = &texture;
    u.texture = second;
    t.points = {{{8, 8}, {12, 8}, {8, 12}}};
    u.points = {{{12 + moved, 8}, {12 + moved, 12}, {8 + moved, 12}}};
    return Estimated({t, u}, LatticePoint(0)).is_at_seam();
  };
  EXPECT_FALSE(seam(0, &texture));
  EXPECT_TRUE(seam(20, &texture));
  EXPECT_TRUE(seam(0, &other));
  EXPECT_TRUE(seam(0, nullptr));
}

// The error of four points drawn in noise is below the tolerance, and not far below.
TEST(CubeEstimate, ToleranceIsThatOfFewPoints) {
  std::vector<uint8_t> rgba;
  Random random(7);
  for (int i = 0; i < 32 * 32; ++i) {
    for (int c = 0; c < 3; ++c) rgba.push_back(random.below(2) == 0 ? 0 : 255);
    rgba.push_back(255);
  }
  const JudgedTexture texture(32, 32, rgba, 0);
  Paint paint;
  JudgedTriangle t = triangle({0, 0, 512}, {16384, 0, 512}, {0, 16384, 512});
  t.paint = &paint;
  t.texture = &texture;
  t.points = {{{0, 0}, {32, 0}, {0, 32}}};
  for (int64_t x = 0; x < 6; ++x) {
    const Estimated cube({t}, {x * kSide, 2 * kSide, 0});
    double mean = 0;
    for (const double u : {0.5, 1.5}) {
      for (const double v : {0.5, 1.5}) mean += texture.at(paint, double(2 * x) + u, 4 + v)[1] / 4;
    }
    EXPECT_NEAR(cube.mean(0), mean, cube.tolerance(0));
    EXPECT_GT(cube.tolerance(0), 0.05);
    EXPECT_LT(cube.tolerance(0), 0.75);
  }
}

// Where a cube spans many texels its colour is that of a coarser level, which reaches beyond it.
TEST(CubeEstimate, ToleranceHoldsANeighbourOnlyForCoarserLevels) {
  std::vector<uint8_t> rgba;
  for (int j = 0; j < 64; ++j) {
    for (int i = 0; i < 64; ++i) {
      const uint8_t code = i < 32 ? 255 : 0;
      rgba.insert(rgba.end(), {code, code, code, 255});
    }
  }
  const JudgedTexture texture(64, 64, rgba, 0);
  Paint paint;
  JudgedTriangle t = triangle({0, 0, 512}, {8192, 0, 512}, {0, 8192, 512});
  t.paint = &paint;
  t.texture = &texture;
  const auto cube = [&](double texels, double from) {
    t.points = {{{from, 0}, {from + 8 * texels, 0}, {from, 8 * texels}}};
    return Estimated({t}, LatticePoint(0));
  };
  EXPECT_LT(cube(3, 28).tolerance(0), 1e-9);  // texels 28 to 31, all white
  EXPECT_GT(cube(8, 23).tolerance(0), 0.1);   // 23 to 31, and four more that are black
}

}  // namespace
}  // namespace svdag
