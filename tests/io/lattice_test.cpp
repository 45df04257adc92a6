#include "io/lattice.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/io/generators.h"

namespace svdag {
namespace {

// A grid of the size of `box`, of either kind.
Grid some_grid(const Box& box, int levels, bool of_lattice) {
  if (!of_lattice) return divide_box(box, levels);
  Grid grid;
  grid.kind = Grid::Kind::kLattice;
  grid.levels = levels;
  grid.voxel_size = divide_box(box, levels).voxel_size;
  grid.k0 = LatticePoint(-2048, 0, 1024);
  grid.selection = grid.whole();
  return grid;
}

// Points in the range of the snap; others are rejected, see
// TwoToThe62StepsAreAnErrorAndOneLessIsNot.
rc::Gen<Point> points_near(const Grid& grid) {
  return rc::gen::suchThat(points(), [grid](const Point& p) {
    const Point offset = (p - grid.origin) / grid.voxel_size;
    const double furthest = std::ldexp(1.0, 61 - grid.fraction());
    return glm::all(glm::lessThan(glm::abs(offset), Point(furthest)));
  });
}

RC_GTEST_PROP(Snap, IsMonotone, ()) {
  const Grid grid = some_grid(*boxes(), *level_counts(), *rc::gen::arbitrary<bool>());
  const Lattice lattice(grid);
  const Point a = *points_near(grid), b = *points_near(grid);
  const LatticePoint qa = lattice.snap(a), qb = lattice.snap(b);
  for (int k = 0; k < 3; ++k) {
    if (a[k] <= b[k]) {
      RC_ASSERT(qa[k] <= qb[k]);
    } else {
      RC_ASSERT(qb[k] <= qa[k]);
    }
  }
}

RC_GTEST_PROP(Snap, MovesNoCoordinateByMoreThanHalfAStep, ()) {
  const Grid grid = some_grid(*boxes(), *level_counts(), *rc::gen::arbitrary<bool>());
  const Lattice lattice(grid);
  double move = 0;
  for (int i = 0; i < 20; ++i) lattice.snap(*points_near(grid), &move);
  RC_ASSERT(move >= 0 && move <= 0.5);
}

// kBox: the formula of io/lattice.h, rounded after every operation.
RC_GTEST_PROP(Snap, OfABoxGridIsTheNearestStepFromTheOrigin, ()) {
  const Grid grid = divide_box(*boxes(), *level_counts());
  const Point p = *points_near(grid);
  const LatticePoint q = Lattice(grid).snap(p);
  for (int k = 0; k < 3; ++k) {
    const double offset = p[k] - grid.origin[k];
    const double quotient = offset / grid.voxel_size;
    RC_ASSERT(double(q[k]) == std::nearbyint(quotient * std::ldexp(1.0, grid.fraction())));
  }
}

// kLattice: the corner changes the result by whole voxels, so tiles of one lattice agree.
RC_GTEST_PROP(Snap, TilesOfOneLatticeAgree, ()) {
  Grid one = some_grid(*boxes(), *level_counts(), true), other = one;
  for (int k = 0; k < 3; ++k) other.k0[k] = 1024 * *any_of<int64_t>(-1'000'000, 1'000'000);
  const Point p = *points_near(one);
  const LatticePoint a = Lattice(one).snap(p), b = Lattice(other).snap(p);
  for (int k = 0; k < 3; ++k)
    RC_ASSERT(a[k] - b[k] == (other.k0[k] - one.k0[k]) * (int64_t(1) << one.fraction()));
}

TEST(Snap, OfALatticePutsPlanesAtHalfOddMultiplesOfTheVoxelSize) {
  Grid grid;
  grid.kind = Grid::Kind::kLattice;
  grid.levels = 10;
  grid.voxel_size = 0.25;
  grid.k0 = LatticePoint(0, 1024, -1024);
  const int64_t voxel = int64_t(1) << grid.fraction();
  const Lattice lattice(grid);
  // Plane k is at (k + 1/2) S: at k0 the lattice coordinate is 0.
  EXPECT_EQ(lattice.snap({0.5 * 0.25, 1024.5 * 0.25, -1023.5 * 0.25}), LatticePoint(0));
  EXPECT_EQ(lattice.snap({1.5 * 0.25, 1025.5 * 0.25, -1022.5 * 0.25}), LatticePoint(voxel));
  EXPECT_EQ(lattice.snap({0.25, 1025 * 0.25, -1023 * 0.25}), LatticePoint(voxel / 2));
}

TEST(Snap, TiesGoToEven) {
  Grid grid;
  grid.levels = 3;
  const double step = std::ldexp(1.0, -grid.fraction());
  double move = 0;
  EXPECT_EQ(Lattice(grid).snap({0.5 * step, 1.5 * step, -0.5 * step}, &move),
            LatticePoint(0, 2, 0));
  EXPECT_EQ(move, 0.5);
}

TEST(Snap, TwoToThe62StepsAreAnErrorAndOneLessIsNot) {
  Grid grid;
  grid.levels = 20;
  const double limit = std::ldexp(1.0, 62 - grid.fraction());
  const Lattice lattice(grid);
  EXPECT_SVDAG_ERROR(lattice.snap({0, limit, 0}), ExitCode::kBadInput, "too far from the grid");
  EXPECT_SVDAG_ERROR(lattice.snap({0, 0, -limit}), ExitCode::kBadInput, "too far from the grid");
  const double below = std::nextafter(limit, 0);
  EXPECT_EQ(lattice.snap({below, -below, 0}),
            LatticePoint((int64_t(1) << 62) - 512, -(int64_t(1) << 62) + 512, 0));
}

// An untrusted k0 could overflow the shift.
TEST(Snap, AGridWithACornerTooFarAwayIsAnError) {
  Grid grid;
  grid.kind = Grid::Kind::kLattice;
  for (const int64_t sign : {-1, 1}) {
    grid.k0[1] = sign * ((int64_t(1) << 38) + 1024);
    EXPECT_NO_THROW(Lattice{grid});
    for (const int64_t far : {int64_t(1) << 39, INT64_MAX}) {
      grid.k0[1] = sign * far;
      EXPECT_THROW(Lattice{grid}, Error);
    }
  }
}

TEST(Snap, NanAndInfinityAreErrors) {
  const Lattice lattice(Grid{});
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(lattice.snap({0, 0, bad}), Error);
}

// The definition: voxel k is the closed interval [k, k + 1] * 2^F.
RC_GTEST_PROP(TouchedVoxels, AreThoseWhoseClosedIntervalHoldsTheCoordinate, ()) {
  Grid grid;
  grid.levels = *level_counts();
  const Lattice lattice(grid);
  const int64_t voxel = int64_t(1) << lattice.fraction();
  const int64_t plane = *any_of<int64_t>(-2000, 2000) * voxel;
  const int64_t q = plane + *any_of<int64_t>(-3, 4);
  const int64_t first = lattice.first_voxel(q), last = lattice.last_voxel(q);
  for (int64_t k = plane / voxel - 3; k <= plane / voxel + 3; ++k) {
    const bool touched = k * voxel <= q && q <= (k + 1) * voxel;
    RC_ASSERT(touched == (first <= k && k <= last));
  }
}

}  // namespace
}  // namespace svdag
