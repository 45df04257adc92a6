#include "io/scene/mesh/name_filter.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

constexpr PartKind kObject = PartKind::kObject, kMaterial = PartKind::kMaterial;

TEST(NameFilter, APatternWithAKindAppliesToThatKindAlone) {
  const NameFilter filter{{"material:brick*"}, {"glass"}};
  EXPECT_TRUE(filter.includes(kMaterial, "brick red"));
  EXPECT_FALSE(filter.includes(kObject, "brick red"));
  EXPECT_TRUE(filter.excludes(kMaterial, "glass"));
  EXPECT_TRUE(filter.excludes(kObject, "glass"));
}

TEST(NameFilter, AColonAfterAnyOtherWordBelongsToTheName) {
  const NameFilter filter{{"wall:*"}, {}};
  EXPECT_TRUE(filter.includes(kObject, "wall:north"));
}

TEST(NameFilter, TheNearestNamesAreThoseThatContainThePatternThenThoseSpelledAlike) {
  NameFilter::Use use{{false}, {}, {}};
  NameFilter filter{{"Windw*"}, {}, &use};
  for (const char* name : {"chimney", "window", "wing", "windwheel", "floor board"})
    filter.includes(kObject, name);
  EXPECT_EQ(nearest_names("Windw*", use), "object:windwheel, object:window, object:wing");
}

TEST(NameFilter, OfEqualNamesTheRightKindIsNearest) {
  const NameFilter::Use use{{}, {}, {{"sky", kMaterial}, {"sky", kObject}}};
  EXPECT_EQ(nearest_names("material:skyy", use), "material:sky, object:sky");
}

}  // namespace
}  // namespace svdag
