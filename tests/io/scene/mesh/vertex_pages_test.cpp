// Positions in pages are found in any order, within the share; in a random order that is costly.
#include "io/scene/mesh/vertex_pages.h"

#include <random>

#include "tests/io/scene/mesh/test_spill.h"

namespace svdag {
namespace {

template <class T>
class Pages {
 public:
  explicit Pages(uint64_t vertices, uint64_t share = 16 * 4096)
      : spill_(share), budget_(share), pages_(*spill_.space(), &budget_, std::is_same_v<T, float>) {
    for (uint64_t i = 0; i < vertices; ++i) {
      const std::array<T, 3> p = {T(i), T(i) / 2, -T(i)};
      pages_.add(std::as_bytes(std::span(&p, 1)));
    }
  }

  static Point expected(uint64_t i) { return {double(T(i)), double(T(i) / 2), -double(T(i))}; }
  void look_up(uint64_t i) { ASSERT_EQ(pages_[i], expected(i)); }
  VertexPages& pages() { return pages_; }
  uint64_t bytes_read() const { return spill_.file()->read_bytes(); }
  uint64_t peak_bytes() const { return spill_.file()->peak_bytes(); }

 private:
  TestSpill spill_;
  MemoryBudget budget_;
  VertexPages pages_;
};

template <class T>
void expect_all_found(uint64_t vertices) {
  std::mt19937_64 random(vertices);
  Pages<T> pages(vertices);
  EXPECT_EQ(pages.pages().size(), vertices);
  for (int i = 0; i < 3000; ++i) pages.look_up(random() % vertices);
  uint64_t next = 0;
  pages.pages().visit([&](uint64_t i, const Point& p) {
    ASSERT_EQ(i, next++);
    ASSERT_EQ(p, Pages<T>::expected(i));
  });
  EXPECT_EQ(next, vertices);
  for (uint64_t i = vertices; i-- > 0;) pages.look_up(i);
}

TEST(VertexPages, EveryVertexIsFound) {
  for (const uint64_t vertices : {1, 335, 336, 337, 10000}) {
    expect_all_found<float>(vertices);
    expect_all_found<double>(vertices);
  }
}

// Two rows at a time, each page is read once, few of them twice.
TEST(VertexPages, RowsAreReadOnce) {
  constexpr uint64_t kRow = 1000, kRows = 100;
  Pages<float> pages(kRow * kRows);
  for (uint64_t i = 0; i < kRow * (kRows - 1); ++i) {
    pages.look_up(i);
    pages.look_up(i + kRow);
    ASSERT_FALSE(pages.pages().is_costly());
  }
  EXPECT_LE(pages.bytes_read(), pages.peak_bytes() * 11 / 10);
  EXPECT_LE(pages.peak_bytes(), 12 * kRow * kRows * 11 / 10);
}

// The least that a file in order looks up: every vertex once.
template <class T>
void expect_soup_is_not_costly() {
  constexpr uint64_t kVertices = 100000;
  Pages<T> pages(kVertices);
  for (uint64_t i = 0; i < kVertices; ++i) {
    pages.look_up(i);
    ASSERT_FALSE(pages.pages().is_costly()) << i;
  }
}

TEST(VertexPages, TrianglesThatShareNothingAreNotCostly) {
  expect_soup_is_not_costly<float>();
  expect_soup_is_not_costly<double>();
}

TEST(VertexPages, ARandomOrderIsCostlyBeforeMuchIsRead) {
  Pages<float> pages(100000);
  std::mt19937_64 random(1);
  int lookups = 0;
  for (; !pages.pages().is_costly() && lookups < 10000; ++lookups) pages.look_up(random() % 100000);
  EXPECT_LT(lookups, 1000);
}

}  // namespace
}  // namespace svdag
