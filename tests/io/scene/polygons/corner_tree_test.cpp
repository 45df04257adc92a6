// What finds ears: the corners in a region, and the next candidate around the ring.
#include "io/scene/polygons/corner_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "io/scene/polygons/ear_candidates.h"

namespace svdag {
namespace {

TEST(CornerTree, FindsACornerInARegionAsLongAsOneIsLeft) {
  std::mt19937 random(1);
  for (const uint32_t n : {1U, 2U, 16U, 17U, 33U, 100U, 1000U}) {
    std::vector<glm::dvec2> points;
    for (uint32_t i = 0; i < n; ++i) points.push_back({random() % 20, random() % 20});
    CornerTree tree;
    tree.build(points);
    std::set<uint32_t> left;
    for (uint32_t i = 0; i < n; ++i) left.insert(i);
    while (!left.empty()) {
      const glm::dvec2 low(random() % 20, random() % 20), high = low + 3.0;
      const auto holds = [&](const glm::dvec2& p) {
        return p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
      };
      const uint32_t found = tree.find(
          [&](const FlatBox& box) {
            return box.max.x >= low.x && box.max.y >= low.y && box.min.x <= high.x &&
                   box.min.y <= high.y;
          },
          [&](uint32_t i) { return holds(points[i]); });
      const bool any =
          std::any_of(left.begin(), left.end(), [&](uint32_t i) { return holds(points[i]); });
      ASSERT_EQ(found != CornerTree::kNone, any);
      ASSERT_TRUE(!any || (left.contains(found) && holds(points[found])));
      const uint32_t gone = any ? found : *left.begin();
      tree.remove(gone);
      left.erase(gone);
    }
  }
}

TEST(CornerTree, PassesOverMostOfTheCorners) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 100000; ++i) points.push_back({i, i % 7});
  CornerTree tree;
  tree.build(points);
  int asked = 0;
  const uint32_t found =
      tree.find([&](const FlatBox& box) { return box.min.x <= 777 && box.max.x >= 777; },
                [&](uint32_t i) {
                  ++asked;
                  return points[i].x == 777;
                });
  EXPECT_EQ(found, 777U);
  EXPECT_LE(asked, 32);
}

TEST(NumberSet, TheNextNumberIsTheOneOfAnOrderedSet) {
  std::mt19937 random(1);
  NumberSet set;  // used again for another size, as for the next polygon
  for (const uint32_t n : {1U, 64U, 300000U, 65U, 5000U}) {
    set.fill(n);
    std::set<uint32_t> expected;
    for (uint32_t i = 0; i < n; ++i) expected.insert(i);
    for (int i = 0; i < 20000; ++i) {
      const uint32_t number = uint32_t(random() % n);
      if (i % 100 == 99) {
        set.insert(number);
        expected.insert(number);
      } else {  // empty at last, but for some
        const auto at = expected.lower_bound(number);
        if (at != expected.end()) {
          set.erase(*at);
          expected.erase(at);
        }
      }
      const uint32_t from = uint32_t(random() % n);
      const auto next = expected.lower_bound(from);
      ASSERT_EQ(set.next(from), next == expected.end() ? UINT32_MAX : *next);
    }
  }
}

TEST(EarCandidates, ACornerThatWaitsIsAskedWhenItsCornerWakesItAndNotBefore) {
  EarCandidates candidates;
  candidates.reset(5);
  for (const uint32_t i : {0U, 1U, 2U}) candidates.wait(i, 4);
  candidates.wait(3, 2);
  EXPECT_EQ(candidates.next(0), 4U);
  candidates.wake(4, [](uint32_t i) { return i == 1; });
  EXPECT_EQ(candidates.next(0), 1U);
  candidates.insert(0);  // tested again for another reason: no longer waits
  candidates.erase(0);
  candidates.erase(1);
  candidates.wake(4, [](uint32_t) { return true; });
  EXPECT_EQ(candidates.next(0), 2U);
  EXPECT_EQ(candidates.next(3), 4U);
}

}  // namespace
}  // namespace svdag
