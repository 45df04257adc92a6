#include "io/scene/mesh/vertex_windows.h"

#include <random>

#include "tests/expect_error.h"
#include "tests/io/scene/mesh/test_spill.h"

namespace svdag {
namespace {

template <class T>
void expect_every_corner(uint64_t share, size_t block_bytes, uint64_t vertices, uint64_t corners) {
  TestSpill spill(share, block_bytes);
  MemoryBudget budget(share);
  VertexWindows windows(*spill.space(), &budget, std::is_same_v<T, float>);
  for (uint64_t i = 0; i < vertices; ++i) {
    const std::array<T, 3> p = {T(i), T(i) / 2, -T(i)};
    windows.add(std::as_bytes(std::span(&p, 1)));
  }
  std::mt19937_64 random(1);
  std::vector<uint64_t> asked;
  std::vector<uint64_t> window;
  for (uint64_t c = 0; c < corners; ++c) {
    asked.push_back(random() % vertices);
    window.push_back(windows.record(asked.back()));
  }
  windows.join();
  for (int run = 0; run < 2; ++run) {
    windows.rewind();
    for (size_t c = 0; c < asked.size(); ++c) {
      const uint64_t i = asked[c];
      ASSERT_EQ(windows.next(window[c]), Point(double(T(i)), double(T(i) / 2), -double(T(i))));
    }
  }
}

// Blocks of 8 KiB do not hold a whole number of positions: some are in two blocks.
TEST(VertexWindows, EveryCornerGetsItsPositionAsOftenAsItIsAskedForWithinTheShare) {
  for (const size_t block : {4096, 8192, 16384}) {
    for (const uint64_t vertices : {1, 700, 5000, 6144}) {
      expect_every_corner<float>(16 * block, block, vertices, 3 * vertices);
      expect_every_corner<double>(16 * block, block, vertices, 40000);
    }
  }
}

TEST(VertexWindows, AShareHoldsAsManyVerticesAsItPromises) {
  for (const uint64_t blocks : {16, 17, 31, 100, 1000}) {
    const uint64_t share = blocks * 4096;
    TestSpill spill(share);
    MemoryBudget budget;
    for (const bool single : {true, false}) {
      const VertexWindows windows(*spill.space(), &budget, single);
      EXPECT_GE(windows.max_vertices() * (single ? 12 : 24), share * share / (8 * 4096));
    }
  }
}

TEST(VertexWindows, ThirtyTwoMebibytesJoinABillionVertices) {
  TestSpill spill(uint64_t(32) << 20, 16384);
  MemoryBudget budget;
  EXPECT_GE(VertexWindows(*spill.space(), &budget, true).max_vertices(), 1000000000U);
  EXPECT_GE(VertexWindows(*spill.space(), &budget, false).max_vertices(), 1000000000U);
}

TEST(VertexWindows, ACornerThatWasNotRecordedIsRefused) {
  TestSpill spill(16 * 4096);
  MemoryBudget budget;
  VertexWindows windows(*spill.space(), &budget, true);
  const std::array<float, 3> p = {1, 2, 3};
  windows.add(std::as_bytes(std::span(&p, 1)));
  windows.record(0);
  windows.join();
  windows.rewind();
  EXPECT_EQ(windows.next(0), Point(1, 2, 3));
  EXPECT_SVDAG_ERROR(windows.next(0), ExitCode::kBadInput, "changed while it was being read");
}

}  // namespace
}  // namespace svdag
