// Triangles of bins are read back exactly, up to the largest coordinates; others are rejected.
#include "builder/split/triangle_bins.h"

#include <gtest/gtest.h>

#include "io/dag/format.h"
#include "io/lattice.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class TriangleBinsTest : public testing::Test {
 protected:
  // Stores a triangle as TriangleBins does, with wrapping arithmetic.
  TriangleBin bin_of(const LatticeTriangle& triangle) {
    TriangleBin bin;
    SpillWriter writer(scratch_.triangles(), scratch_.new_streams(), &budget_);
    for (size_t i = 0; i < 3; ++i) {
      for (int a = 0; a < 3; ++a) {
        const uint64_t from = i == 0 ? 0 : uint64_t(triangle.v[0][a]);
        put(uint64_t(triangle.v[i][a]) - from, &writer);
      }
    }
    put(4 * uint64_t(triangle.subject) + triangle.sheet, &writer);
    bin.triangles = 1;
    bin.stream = writer.finish();
    return bin;
  }

  std::vector<LatticeTriangle> read(const TriangleBin& bin) {
    std::vector<LatticeTriangle> triangles;
    BinReader(scratch_.triangles(), bin, &budget_).read(bin.triangles, &triangles, &cuts_);
    return triangles;
  }

  CutRecords cuts_;
  MemoryBudget budget_{uint64_t(64) << 20};
  TempFolder temp_;
  ScratchDir folder_{temp_.file("scratch")};
  Scratch scratch_{&folder_, &budget_};

 private:
  static void put(uint64_t value, SpillWriter* writer) {
    uint64_t code = value << 1 ^ (0 - (value >> 63));
    for (bool more = true; more; code >>= 7) {
      more = code >= 0x80;
      const auto byte = std::byte((code & 0x7f) | (more ? 0x80U : 0U));
      writer->append({&byte, 1});
    }
  }
};

// The snap accepts a vertex at nearly 2^62 steps from zero, and shifts it by nearly 2^61 more.
TEST_F(TriangleBinsTest, TheFarthestVertexThatTheSnapAcceptsIsReadBack) {
  const double far = 0x1p38 - 4096;
  for (const double side : {1.0, -1.0}) {
    Box box;
    box.add(Point(side * far));
    box.add(Point(side * (far + 4)));
    const Grid grid = cover_lattice(box, 1);
    const Lattice lattice(grid);
    const Point opposite(-side * (0x1p39 - 1), side * far, side * far);
    const LatticeTriangle triangle = {
        {lattice.snap(Point(side * far)),
         lattice.snap(Point(side * (far + 2), side * far, side * far)), lattice.snap(opposite)}};
    ASSERT_GT(std::abs(triangle.v[2].x), int64_t(1) << 62);
    TriangleBins bins(grid, Cube(), 1, scratch_.triangles(), &scratch_);
    bins.add(triangle);
    const std::vector<TriangleBin> made = bins.finish();
    ASSERT_FALSE(made.empty());
    for (const TriangleBin& bin : made) EXPECT_EQ(read(bin), std::vector{triangle});
  }
}

TEST_F(TriangleBinsTest, VerticesThatTheSnapCannotProduceAreReportedAsDamage) {
  constexpr int64_t kFar = (int64_t(1) << 62) + (int64_t(1) << 61);
  const LatticePoint zero(0), far(kFar, 0, 0), too_far(kFar + (int64_t(1) << 34), 0, 0);
  EXPECT_EQ(read(bin_of({{zero, far, zero}})).size(), 1U);
  EXPECT_SVDAG_ERROR(read(bin_of({{too_far, zero, zero}})), ExitCode::kOutput, "damaged");
  EXPECT_SVDAG_ERROR(read(bin_of({{zero, zero, -too_far}})), ExitCode::kOutput, "damaged");
  // Each is valid alone, but their difference overflows.
  EXPECT_SVDAG_ERROR(read(bin_of({{far, -far, zero}})), ExitCode::kOutput, "damaged");
}

TEST_F(TriangleBinsTest, ALayerThatCannotExistIsReportedAsDamage) {
  LatticeTriangle triangle{};
  triangle.subject = kMaxLayers;
  triangle.sheet = kSheetOfUnion | kSheetOfLayer;
  EXPECT_EQ(read(bin_of(triangle)).at(0), triangle);
  ++triangle.subject;
  EXPECT_SVDAG_ERROR(read(bin_of(triangle)), ExitCode::kOutput, "damaged");
}

}  // namespace
}  // namespace svdag
