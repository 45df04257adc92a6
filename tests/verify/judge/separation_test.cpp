// Tests that a thin closed mesh separates inside from outside: no path of free voxels crosses it.
#include <gtest/gtest.h>

#include <random>

#include "tests/verify/judged_voxels.h"
#include "tests/verify/symbolic_thin.h"

namespace svdag {
namespace {

// Half the side of the grid, in voxels; tetrahedra keep one voxel away from the border.
constexpr int64_t kReach = 9;
constexpr int kSize = 2 * int(kReach);

// The free voxels that a path over faces reaches from the corner of the grid, which is outside.
class Flood {
 public:
  explicit Flood(const VoxelSet& walls) : state_(size_t(kSize * kSize * kSize), 0) {
    for (const auto& [x, y, z] : walls) at({x, y, z}) = kWall;
    std::vector<LatticePoint> pending{LatticePoint(-kReach)};
    at(pending.back()) = kReached;
    while (!pending.empty()) {
      const LatticePoint from = pending.back();
      pending.pop_back();
      for (int i = 0; i < 6; ++i) {
        LatticePoint to = from;
        to[i / 2] += i % 2 ? 1 : -1;
        if (to[i / 2] < -kReach || to[i / 2] >= kReach || at(to) != 0) continue;
        at(to) = kReached;
        pending.push_back(to);
      }
    }
  }
  bool reached(const LatticePoint& p) { return at(p) == kReached; }

 private:
  static constexpr char kWall = 1, kReached = 2;
  char& at(const LatticePoint& p) {
    const LatticePoint q = p + kReach;
    return state_[size_t((q.x * kSize + q.y) * kSize + q.z)];
  }
  std::vector<char> state_;
};

using Plane = SymbolicForm<Int128>;  // with coordinates below 2^27 its values are below 2^85

// planes[i] is that of the face opposite to corners[i].
struct Tetrahedron {
  std::array<LatticePoint, 4> corners;
  std::array<Plane, 4> planes;

  LatticeTriangle face(size_t i) const {
    return {{corners[(i + 1) % 4], corners[(i + 2) % 4], corners[(i + 3) % 4]}};
  }
  // True if the symbolically shifted point is inside; a flat tetrahedron contains no point.
  bool contains(const LatticePoint& p) const {
    for (size_t i = 0; i < 4; ++i) {
      const Int128 at_corner = planes[i].value_at(corners[i]);
      if (at_corner == 0 || planes[i].sign_at(p) != (at_corner < 0 ? -1 : 1)) return false;
    }
    return true;
  }
};

Tetrahedron random_tetrahedron(std::mt19937_64& random, int shift) {
  const int64_t limit = (kReach - 1) << shift;
  Tetrahedron t;
  for (LatticePoint& q : t.corners) {
    for (int a = 0; a < 3; ++a) q[a] = int64_t(random() % uint64_t(2 * limit + 1)) - limit;
  }
  for (size_t i = 0; i < 4; ++i) t.planes[i] = plane_of<Int128>(t.face(i));
  return t;
}

TEST(Separation, ThinShellsOf1500TetrahedraHaveNoLeak) {
  std::mt19937_64 random(1);
  const VoxelBox window{LatticePoint(-kReach), LatticePoint(kReach)};
  uint64_t tested = 0, leaks = 0;
  for (int i = 0; i < 1500; ++i) {
    const int shift = 1 + i % 4 * 7;  // from 2 lattice steps a voxel, where all tests tie, to 2^22
    const Tetrahedron t = random_tetrahedron(random, shift);
    VoxelSet walls;
    for (size_t f = 0; f < 4; ++f) walls.merge(thin_set(t.face(f), shift, window));
    Flood flood(walls);
    for (int64_t k = 0; k < kSize * kSize * kSize; ++k) {
      const LatticePoint voxel =
          LatticePoint(k / (kSize * kSize), k / kSize % kSize, k % kSize) - kReach;
      if (walls.count({voxel.x, voxel.y, voxel.z})) continue;
      if (!t.contains(centre_of(voxel, shift))) continue;
      ++tested;
      leaks += flood.reached(voxel) ? 1 : 0;
    }
  }
  EXPECT_EQ(leaks, 0U);
  EXPECT_GT(tested, 20000U);
  std::printf("%llu inside voxels tested\n", static_cast<unsigned long long>(tested));
}

}  // namespace
}  // namespace svdag
