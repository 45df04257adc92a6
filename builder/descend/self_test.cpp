#include "builder/descend/self_test.h"

#include "builder/descend/rules.h"
#include "builder/descend/voxelize_window.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

constexpr int kTriangles = 60;
constexpr int kLevels = 6;

// Steele, Lea, Flood: Fast splittable pseudorandom number generators, OOPSLA 2014.
class SplitMix {
 public:
  uint64_t next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }

 private:
  uint64_t state_ = 0;
};

// Coordinates are multiples of a unit: a lattice step, an eighth or half of a voxel, or a voxel.
std::vector<LatticeTriangle> some_triangles(const Grid& grid) {
  const int f = grid.fraction();
  const int side = kLevels + f;
  std::vector<LatticeTriangle> triangles(kTriangles);
  SplitMix random;
  for (int i = 0; i < kTriangles; ++i) {
    const int unit = std::array{0, f - 3, f - 1, f}[size_t(i % 4)];
    const int reach = std::array{side, side + 1, side - 2, 45}[size_t(i / 4 % 4)];
    for (LatticePoint& p : triangles[size_t(i)].v) {
      for (int a = 0; a < 3; ++a) {
        const int64_t away = int64_t(random.next() >> (64 - reach)) - (int64_t(1) << (reach - 1));
        p[a] = ((away >> unit) << unit) + (int64_t(1) << (side - 1));  // around the grid's centre
      }
    }
  }
  return triangles;
}

Hash128 hash_of_voxels(const DescentConfig& config, uint64_t* bricks) {
  Grid grid;
  grid.levels = kLevels;
  grid.selection = grid.whole();
  Hasher128 hasher;
  voxelize_window(grid, config, {}, some_triangles(grid), [&](const LatticePoint& at, Brick brick) {
    const uint64_t words[2] = {uint64_t(at.x << 32 | at.y << 16 | at.z), brick};
    hasher.update(std::as_bytes(std::span(words)));
    ++*bricks;
  });
  return hasher.digest();
}

}  // namespace

uint64_t self_test(const DescentConfig& config) {
  uint64_t bricks = 0;
  const SurfaceRule& rule = surface_rule(config.rule);
  DescentConfig surface = config;
  surface.rule = rule.rule;  // the triangles bound no solid
  const std::string found = to_hex(hash_of_voxels(surface, &bricks));
  if (found != rule.self_test_hash)
    throw Error(ExitCode::kInternal, std::string("the self-test of the voxelizer failed: this "
                                                 "machine or this build computes wrong voxels "
                                                 "(kernels ") +
                                         config.kernels->name + ", " + found + ")");
  return 64 * bricks;
}

}  // namespace svdag
