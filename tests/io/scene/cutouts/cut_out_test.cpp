#include "io/scene/cutouts/cut_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "io/scene/cutouts/cut_triangle.h"
#include "io/scene/gltf/gltf_texture.h"

namespace svdag {
namespace {

std::mt19937 engine(3);

double uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}
int whole(int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(engine);
}

// Smooth or noisy, of any size, wrapped in any way.
CutOut random_cut() {
  const int width = whole(1, 37), height = whole(1, 37), kind = whole(0, 2);
  std::vector<uint8_t> texels;
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const double wave = 127.5 + 127.5 * std::sin(i * 0.7) * std::cos(j * 0.4);
      texels.push_back(uint8_t(kind == 0 ? whole(0, 255) : kind == 1 ? 255 * whole(0, 1) : wave));
    }
  }
  CutOut cut;
  cut.image = std::make_shared<AlphaImage>(width, height, texels);
  cut.wrap_u = Wrap(whole(0, 2));
  cut.wrap_v = Wrap(whole(0, 2));
  cut.nearest = whole(0, 1) == 1;
  return with_map(cut);
}

// The centre of the texel that a cell begins with is a point of it.
TEST(OpacityMap, ARectangleIsAsItsCellsAre) {
  int decided = 0, mixed = 0;
  for (int k = 0; k < 20000; ++k) {
    const CutOut cut = random_cut();
    const int i0 = whole(-90, 90), i1 = i0 + whole(0, 12), j0 = whole(-90, 90),
              j1 = j0 + whole(0, 12);
    bool some = false, all = true;
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const Opacity cell = cut.map->opacity({{i, i}, {j, j}});
        some |= cell != Opacity::kTransparent;
        all &= cell == Opacity::kOpaque;
        EXPECT_EQ(cut.map->opacity_at(i + 0.75, j + 0.75), cell);
        const bool is_opaque = alpha_at(cut, {i + 0.5, j + 0.5}) >= cut.threshold;
        EXPECT_TRUE(is_opaque ? cell != Opacity::kTransparent : cell != Opacity::kOpaque);
      }
    }
    const Opacity opacity = cut.map->opacity({{i0, i1}, {j0, j1}});
    if (opacity == Opacity::kMixed) {
      ++mixed;
      continue;
    }
    ++decided;
    EXPECT_EQ(opacity == Opacity::kOpaque, all);
    EXPECT_EQ(opacity == Opacity::kTransparent, !some);
  }
  EXPECT_GT(decided, 1000);
  EXPECT_GT(mixed, 1000);
}

TEST(OpacityMap, BlocksHoldTheirCellsAndSamplesAreOpaque) {
  int samples = 0;
  for (int k = 0; k < 20000; ++k) {
    const CutOut cut = random_cut();
    const int i0 = whole(-60, 60), i1 = i0 + whole(0, 30), j0 = whole(-60, 60),
              j1 = j0 + whole(0, 30);
    OpacityMap::Blocks blocks;
    if (cut.map->opacity({{i0, i1}, {j0, j1}}, &blocks) != Opacity::kMixed) continue;
    for (int row = 0; row < (blocks.columns > 0 ? blocks.rows : 0); ++row) {
      for (int column = 0; column < blocks.columns; ++column) {
        const auto bits = uint8_t(blocks.bits[row] >> 8 * column);
        const double u = blocks.u + column * blocks.size, v = blocks.v + row * blocks.size;
        if ((bits & OpacityMap::kSample) != 0) {
          ++samples;
          EXPECT_GT(alpha_at(cut, {u + blocks.sample, v + blocks.sample}), cut.threshold);
        }
        for (int n = 0; n < 4; ++n) {
          const double half = 0.4999 * blocks.size;
          const TexturePoint p = {u + uniform(-half, half), v + uniform(-half, half)};
          const double edge = cut.nearest ? 0 : 0.5;
          if (p.u - edge < i0 || p.u - edge >= i1 + 1 || p.v - edge < j0 || p.v - edge >= j1 + 1)
            continue;  // a block may reach beyond the rectangle, and the texture
          const bool is_opaque = alpha_at(cut, p) >= cut.threshold;
          EXPECT_TRUE(is_opaque ? (bits & OpacityMap::kSome) != 0 : (bits & OpacityMap::kAll) == 0);
        }
      }
    }
  }
  EXPECT_GT(samples, 1000);
}

TEST(CutOut, NoPointNearContradictsTheOpacity) {
  int decided = 0;
  for (int k = 0; k < 20000; ++k) {
    const CutOut cut = random_cut();
    const TexturePoint centre{uniform(-60, 60), uniform(-60, 60)};
    const double half_u = uniform(0, 2), half_v = uniform(0, 2);
    OpacityMap::Blocks blocks;
    const Opacity opacity = opacity_near(cut, centre, half_u, half_v, &blocks);
    if (opacity == Opacity::kMixed) continue;
    ++decided;
    for (int n = 0; n < 20; ++n) {
      const TexturePoint p{centre.u + uniform(-half_u, half_u),
                           centre.v + uniform(-half_v, half_v)};
      EXPECT_EQ(alpha_at(cut, p) >= cut.threshold, opacity == Opacity::kOpaque);
    }
  }
  EXPECT_GT(decided, 3000);
}

TEST(CutOut, AnOpaquePointIsFoundWhereThereIsOne) {
  int with = 0, without = 0;
  for (int k = 0; k < 4000; ++k) {
    const CutOut cut = random_cut();
    TexturePolygon triangle;
    const double size = uniform(0.01, 6), u = uniform(-40, 40), v = uniform(-40, 40);
    for (int i = 0; i < 3; ++i) triangle.add({u + uniform(0, size), v + uniform(0, size)});
    double largest = -1;
    for (int n = 0; n < 400; ++n) {
      double a = uniform(0, 1), b = uniform(0, 1);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const auto& c = triangle.corners;
      largest = std::max(largest,
                         alpha_at(cut, {c[0].u + a * (c[1].u - c[0].u) + b * (c[2].u - c[0].u),
                                        c[0].v + a * (c[1].v - c[0].v) + b * (c[2].v - c[0].v)}));
    }
    const bool found = has_opaque_point(cut, triangle);
    if (largest >= cut.threshold + 1e-9) {
      EXPECT_TRUE(found);
    }
    // A small triangle is sampled so densely that it has no much more opaque point.
    if (!cut.nearest && size < 0.3 && largest < cut.threshold - 40) {
      EXPECT_FALSE(found);
    }
    with += found;
    without += !found;
  }
  EXPECT_GT(with, 1000);
  EXPECT_GT(without, 200);
}

TEST(CutOut, IsOpaqueIfNoTexelIsTransparent) {
  CutOut cut;
  cut.image = std::make_shared<AlphaImage>(3, 1, std::vector<uint8_t>{255, 128, 200});
  EXPECT_TRUE(cut.is_opaque());
  cut.threshold = 129;
  EXPECT_FALSE(cut.is_opaque());
}

TEST(CutOut, CoordinatesAreScaledThenRotatedThenMoved) {
  GltfTextureUse turned;  // counter-clockwise by a quarter: v points down
  turned.scale[0] = 3;
  turned.sine = 1;
  turned.cosine = 0;
  turned.offset[0] = 0.5;
  const TexturePoint right = turned.place(1, 0, 4, 2), down = turned.place(0, 1, 4, 2);
  EXPECT_EQ(right.u, 0.5 * 4);
  EXPECT_EQ(right.v, -3 * 2);
  EXPECT_EQ(down.u, 1.5 * 4);
  EXPECT_EQ(down.v, 0);
}

TEST(CutOut, ASaddleIsOpaqueOnlyWhereItIs) {
  CutOut cut;
  cut.image = std::make_shared<AlphaImage>(2, 2, std::vector<uint8_t>{255, 0, 0, 255});
  cut.wrap_u = cut.wrap_v = Wrap::kClamp;
  cut.threshold = 130;
  cut = with_map(cut);
  TexturePolygon edge;  // through the middle, where the alpha is 127.5
  edge.add({1, 0.5});
  edge.add({1, 1.5});
  EXPECT_FALSE(has_opaque_point(cut, edge));
  edge.corners[0] = {0.5, 0.5};
  edge.corners[1] = {1.5, 1.5};
  EXPECT_TRUE(has_opaque_point(cut, edge));
  // Its only opaque points are inside of the edge: 510 t (1 - t).
  cut.threshold = 127;
  cut = with_map(cut);
  edge.corners[0] = {0.75, 1.25};
  edge.corners[1] = {1.25, 0.75};
  EXPECT_TRUE(has_opaque_point(cut, edge));
}

CutTriangle random_triangle(int64_t reach) {
  CutTriangle t{};
  const double texels = whole(0, 1) == 0 ? 3 : 30;
  for (size_t i = 0; i < 3; ++i) {
    for (int a = 0; a < 3; ++a) t.triangle.v[i][a] = whole(int(-reach), int(reach));
    t.corners[i] = {uniform(-texels, texels), uniform(-texels, texels)};
  }
  return t;
}

constexpr int64_t kVoxel = 256;

TEST(CutTriangle, OrderAndWindingDoNotMatter) {
  for (int k = 0; k < 3000; ++k) {
    const CutOut cut = random_cut();
    const CutTriangle t = random_triangle(4 * kVoxel);
    CutTriangle other = t;
    std::swap(other.triangle.v[0], other.triangle.v[2]);
    std::swap(other.corners[0], other.corners[2]);
    const LatticePoint corner(whole(-2, 1) * kVoxel, whole(-2, 1) * kVoxel, whole(-2, 1) * kVoxel);
    for (const bool thin : {false, true})
      EXPECT_EQ(is_opaque_in_voxel(cut, t, corner, kVoxel, thin),
                is_opaque_in_voxel(cut, other, corner, kVoxel, thin));
  }
}

// What a plane decides of a cube or a voxel is what the plain way decides of each voxel.
TEST(CutPlane, DecidesAsVoxelsDo) {
  int opaque = 0, transparent = 0, voxels = 0, cubes = 0;
  for (int k = 0; k < 40000; ++k) {
    const CutOut cut = random_cut();
    const CutTriangle t = random_triangle(whole(0, 1) == 0 ? 4 * kVoxel : 100000);
    const LatticePoint corner(whole(-2, 0) * kVoxel, whole(-2, 0) * kVoxel, whole(-2, 0) * kVoxel);
    const bool thin = whole(0, 1) == 1;
    const CutPlane plane(cut, t, kVoxel);
    const Opacity cube = plane.in_cube(corner, 2 * kVoxel);
    const Opacity any = plane.any_in_cube(corner, 2 * kVoxel);
    cubes += cube != Opacity::kMixed;
    CutOut all = cut;
    all.threshold = 0;
    all = with_map(all);
    bool is_met = false, has_opaque = false;
    for (int v = 0; v < 8; ++v) {
      const int x = v & 1, y = v >> 1 & 1, z = v >> 2;
      const LatticePoint at = corner + LatticePoint(x, y, z) * kVoxel;
      is_met |= is_opaque_in_voxel(all, t, at, kVoxel, false);
      has_opaque |= is_opaque_in_voxel(cut, t, at, kVoxel, false);
      if (!is_opaque_in_voxel(all, t, at, kVoxel, thin)) continue;  // the triangle misses it
      const bool own = is_opaque_in_voxel(cut, t, at, kVoxel, thin);
      EXPECT_TRUE(cube == Opacity::kMixed || own == (cube == Opacity::kOpaque));
      const Opacity at_once = thin ? plane.in_cube(at, kVoxel) : plane.any_in_cube(at, kVoxel);
      EXPECT_TRUE(at_once == Opacity::kMixed || own == (at_once == Opacity::kOpaque));
      voxels += at_once != Opacity::kMixed;
      opaque += own;
      transparent += !own;
    }
    if (is_met) {
      EXPECT_TRUE(any == Opacity::kMixed || has_opaque == (any == Opacity::kOpaque));
    }
  }
  EXPECT_GT(opaque, 1000);
  EXPECT_GT(transparent, 1000);
  EXPECT_GT(voxels, 2000);
  EXPECT_GT(cubes, 1000);
}

}  // namespace
}  // namespace svdag
