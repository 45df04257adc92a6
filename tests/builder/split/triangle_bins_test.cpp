// Triangles of bins are read back exactly, up to the largest coordinates; others are rejected.
#include "builder/split/triangle_bins.h"

#include <gtest/gtest.h>

#include <random>

#include "io/dag/format.h"
#include "io/lattice.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class TriangleBinsTest : public testing::Test {
 protected:
  TriangleBin bin_of_bytes(const std::vector<uint8_t>& bytes, uint64_t triangles) {
    SpillWriter writer(scratch_.triangles(), scratch_.new_streams(), &budget_);
    writer.append(std::as_bytes(std::span(bytes)));
    return {{}, {}, triangles, writer.finish()};
  }
  // Stores a triangle as TriangleBins does a first one that repeats no corner.
  TriangleBin bin_of(const LatticeTriangle& triangle) {
    std::vector<uint8_t> bytes = {VertexRing::kMinLog2, 1};
    put(4 * uint64_t(triangle.subject) + triangle.sheet, &bytes);
    LatticePoint before(0);
    for (size_t i = 0; i < 3; ++i) {
      if (i > 0) bytes.push_back(0);
      for (int a = 0; a < 3; ++a) put(uint64_t(triangle.v[i][a]) - uint64_t(before[a]), &bytes);
      before = triangle.v[i];
    }
    return bin_of_bytes(bytes, 1);
  }

  std::vector<LatticeTriangle> read(const TriangleBin& bin, size_t materials = 0) {
    std::vector<LatticeTriangle> triangles;
    BinReader reader(scratch_.triangles(), bin, &budget_, materials);
    while (reader.read(100, &triangles, &cuts_)) {
    }
    return triangles;
  }
  // The one bin of triangles that are all in the first cube below the root.
  TriangleBin bin_of_all(const std::vector<LatticeTriangle>& triangles) {
    TriangleBins bins(grid_, Cube(), 1, scratch_.triangles(), &scratch_);
    for (const LatticeTriangle& t : triangles) bins.add(t);
    const std::vector<TriangleBin> made = bins.finish();
    EXPECT_EQ(made.size(), 1U);
    return made.at(0);
  }
  Grid grid() {
    Grid grid;
    grid.levels = 10;
    grid.selection = grid.whole();
    return grid;
  }

  Grid grid_ = grid();
  CutRecords cuts_;
  MemoryBudget budget_{uint64_t(64) << 20};
  TempFolder temp_;
  ScratchDir folder_{temp_.file("scratch")};
  Scratch scratch_{&folder_, &budget_};

 private:
  static void put(uint64_t value, std::vector<uint8_t>* bytes) {
    uint64_t code = value << 1 ^ (0 - (value >> 63));
    for (; code >= 0x80; code >>= 7) bytes->push_back(uint8_t(code | 0x80));
    bytes->push_back(uint8_t(code));
  }
};

// A coordinate that the first cube holds, or that is below the grid: of any magnitude.
int64_t any_coordinate(std::mt19937_64& random) {
  const int64_t q = int64_t(random() >> (2 + random() % 62));
  return random() % 2 == 0 ? -q : q % (int64_t(1) << 31);
}

// Corners out of few vertices are found again, out of many not: the ring has forgotten them.
TEST_F(TriangleBinsTest, AllTrianglesAreReadBackInTheirOrderWhateverTheyShare) {
  std::mt19937_64 random(1);
  for (const size_t vertex_count : {1, 3, 100, 255, 256, 257, 3000}) {
    std::vector<LatticePoint> vertices(vertex_count);
    for (LatticePoint& p : vertices) {
      const LatticePoint& near = vertices[random() % vertex_count];
      const bool is_near = random() % 4 != 0;
      for (int a = 0; a < 3; ++a)
        p[a] = is_near ? std::min(near[a] + int64_t(random() % 99), int64_t(1) << 31)
                       : any_coordinate(random);
    }
    std::vector<LatticeTriangle> triangles(5000);
    size_t around = 0;
    for (LatticeTriangle& t : triangles) {
      if (random() % 100 == 0) around = random() % vertex_count;
      for (LatticePoint& p : t.v) p = vertices[(around + random() % 40) % vertex_count];
      around += random() % 3;
      if (random() % 10 == 0) t.v[1] = t.v[0];
      if (random() % 5 != 0) continue;
      t.subject = random() % 2 == 0 ? 1 + uint32_t(random() % kMaxLayers) : 0;
      t.sheet = uint32_t(random() & kSheets);
    }
    EXPECT_EQ(read(bin_of_all(triangles)), triangles) << vertex_count;
  }
}

TEST_F(TriangleBinsTest, ATriangleThatSharesItsVerticesTakesAFewBytes) {
  constexpr int kSide = 60;
  std::vector<LatticeTriangle> grid;
  std::mt19937_64 random(2);
  std::vector<LatticePoint> vertices;
  for (int i = 0; i < kSide * kSide; ++i)
    vertices.emplace_back(i % kSide << 23, i / kSide << 23, random() % (1 << 24));
  for (int i = 0; i + kSide + 1 < kSide * kSide; ++i) {
    const auto v = [&](int k) { return vertices[size_t(i + k)]; };
    grid.push_back({{v(0), v(1), v(kSide)}});
    grid.push_back({{v(1), v(kSide), v(kSide + 1)}});
  }
  EXPECT_LE(bin_of_all(grid).stream.bytes, 12 * grid.size());
  EXPECT_GE(bin_of_all({grid[0]}).stream.bytes, 30U);
}

TEST_F(TriangleBinsTest, CutTrianglesKeepTheirRecords) {
  std::mt19937_64 random(3);
  TriangleBins bins(grid_, Cube(), 1, scratch_.triangles(), &scratch_);
  std::vector<LatticeTriangle> triangles(300);
  CutRecords records;
  for (LatticeTriangle& t : triangles) {
    for (LatticePoint& p : t.v) p = LatticePoint(random() % 99, random() % 2, 7);
    t.subject = uint32_t(random() % 3);
    if (random() % 2 == 0) {
      const auto u = float(random() % 1000);
      t = with_record(t, {{TexturePoint(u, 1), {2, u}, {u, u}}, uint32_t(random() % 4)}, &records);
    }
    bins.add(t, cut_record_of(t, records));
  }
  EXPECT_EQ(read(bins.finish().at(0), 4), triangles);
  ASSERT_EQ(cuts_.size(), records.size());
  for (size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(cuts_[i].corners, records[i].corners);
    EXPECT_EQ(cuts_[i].material, records[i].material);
  }
}

// Blocks with a valid checksum, as those of a plan from elsewhere: an Error or possible triangles.
TEST_F(TriangleBinsTest, RandomBytesAreDamageOrTriangles) {
  std::mt19937_64 random(4);
  int damaged = 0, triangles = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<uint8_t> bytes(1 + random() % 200);
    const uint64_t small = random() % 2 == 0 ? 256 : 4;
    for (uint8_t& byte : bytes) byte = uint8_t(random() % 8 == 0 ? random() : random() % small);
    if (round % 4 != 0) bytes[0] = VertexRing::kMinLog2;
    try {
      triangles += int(read(bin_of_bytes(bytes, 1 + random() % 9), 2).size());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kOutput);
      ++damaged;
    }
    cuts_.clear();
  }
  EXPECT_GT(damaged, 1000);
  EXPECT_GT(triangles, 20);
}

TEST_F(TriangleBinsTest, ARingOrADistanceThatCannotBeIsReportedAsDamage) {
  constexpr uint8_t kLog2 = VertexRing::kMinLog2;
  EXPECT_EQ(read(bin_of_bytes({kLog2, 0, 2, 2, 2, 1, 1}, 1)).size(), 1U);
  EXPECT_SVDAG_ERROR(read(bin_of_bytes({kLog2, 0, 2, 2, 2, 1, 2}, 1)), ExitCode::kOutput,
                     "damaged");
  EXPECT_SVDAG_ERROR(read(bin_of_bytes({kLog2, 2, 1, 1}, 1)), ExitCode::kOutput, "damaged");
  EXPECT_SVDAG_ERROR(read(bin_of_bytes({kLog2, 0, 2, 2, 2, 1}, 1)), ExitCode::kOutput, "damaged");
  for (const int log2 : {0, kLog2 - 1, VertexRing::kMaxLog2 + 1, 255})
    EXPECT_SVDAG_ERROR(read(bin_of_bytes({uint8_t(log2), 0, 2, 2, 2, 1, 1}, 1)), ExitCode::kOutput,
                       "damaged");
}

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
