// What holds for every kind of scene.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>

#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/numbers.h"
#include "tests/scenes/permutation.h"
#include "tests/scenes/ply_writer.h"
#include "tests/temp_folder.h"

namespace svdag::scenes {
namespace {

constexpr uint64_t kSmall[] = {90'000, 10'000, 10'000, 10'000, 10'000,
                               2,      2,      10'000, 15'000};  // in the order of kinds()

using Position = std::array<double, 3>;
using Soup = std::multiset<std::array<Position, 3>>;

Position position(const Point& p) {
  return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}

// The triangles of a mesh, each beginning at its smallest corner.
Soup soup_of(const Mesh& mesh) {
  Soup soup;
  for (uint64_t i = 0; i < mesh.faces(); ++i) {
    std::array<Position, 3> t;
    for (size_t k = 0; k < 3; ++k) t[k] = position(quantised(mesh.vertex(mesh.face(i)[k])));
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    soup.insert(t);
  }
  return soup;
}

// A PLY file in memory as a mesh.
class PlyMesh : public Mesh {
 public:
  explicit PlyMesh(const std::string& bytes) {
    const auto number = [&](const std::string& key) {
      return std::stoull(bytes.substr(bytes.find(key) + key.size()));
    };
    const size_t wide = bytes.find("property double") != std::string::npos ? 8 : 4;
    const char* at = bytes.data() + bytes.find("end_header\n") + 11;
    vertices_.resize(number("element vertex "));
    for (Point& p : vertices_)
      for (int a = 0; a < 3; ++a, at += wide)
        p[a] = wide == 8 ? get<double>(at) : double(get<float>(at));
    faces_.resize(number("element face "));
    for (Face& f : faces_) {
      EXPECT_EQ(get<uint8_t>(at), 3);
      ++at;
      for (size_t k = 0; k < 3; ++k, at += 4) f[k] = get<uint32_t>(at);
    }
    EXPECT_EQ(at, bytes.data() + bytes.size());
  }
  uint64_t vertices() const override { return vertices_.size(); }
  uint64_t faces() const override { return faces_.size(); }
  Point vertex(uint64_t i) const override { return vertices_.at(i); }
  Face face(uint64_t i) const override { return faces_.at(i); }

 private:
  template <class T>
  static T get(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  std::vector<Point> vertices_;
  std::vector<Face> faces_;
};

PlyMesh written(const Mesh& mesh, const PlyOptions& options) {
  const TempFolder folder;
  write_ply(mesh, options, folder.file("a.ply"));
  return PlyMesh(folder.read("a.ply"));
}

TEST(EveryKind, HasAboutAsManyTrianglesAsAskedForAndValidFaces) {
  for (size_t k = 0; k < kinds().size(); ++k) {
    const auto mesh = make_scene(kinds()[k].name, kSmall[k], 1);
    EXPECT_LE(mesh->faces(), kSmall[k]) << kinds()[k].name;
    EXPECT_GE(mesh->faces(), kSmall[k] * 8 / 10) << kinds()[k].name;
    for (uint64_t i = 0; i < mesh->faces(); ++i) {
      const Face f = mesh->face(i);
      ASSERT_TRUE(f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) << kinds()[k].name << i;
      ASSERT_LT(std::max({f[0], f[1], f[2]}), mesh->vertices()) << kinds()[k].name << i;
    }
  }
}

TEST(EveryKind, FitsItsWorldAndFollowsTheSeed) {
  for (size_t k = 0; k < kinds().size(); ++k) {
    const auto one = make_scene(kinds()[k].name, kSmall[k], 1),
               other = make_scene(kinds()[k].name, kSmall[k], 2);
    for (uint64_t i = 0; i < one->vertices(); ++i) ASSERT_LT(length(one->vertex(i)), 128);
    if (kSmall[k] == 2) continue;  // rectangle and sheet have no seed
    EXPECT_NE(soup_of(*one), soup_of(*other)) << kinds()[k].name;
  }
}

TEST(Ply, HoldsTheMeshInFloatAndDouble) {
  for (size_t k = 0; k < kinds().size(); ++k) {
    const auto mesh = make_scene(kinds()[k].name, kSmall[k], 3);
    const Soup soup = soup_of(*mesh);
    EXPECT_EQ(soup_of(written(*mesh, {})), soup) << kinds()[k].name;
    EXPECT_EQ(soup_of(written(*mesh, {.double_precision = true})), soup) << kinds()[k].name;
  }
}

// The few towers of a small city stay within the world, where floats hold what doubles hold.
TEST(Ply, HoldsSmallCitiesInFloatAndDouble) {
  for (const uint64_t seed : {1U, 67U, 1000U}) {
    const auto mesh = make_scene("city", 24, seed);
    EXPECT_EQ(soup_of(written(*mesh, {})), soup_of(written(*mesh, {.double_precision = true})));
  }
}

TEST(Ply, ShufflingChangesTheOrderAlone) {
  const auto mesh = make_scene("city", 1'200, 1);
  const PlyMesh plain = written(*mesh, {}), shuffled = written(*mesh, {.shuffle = true});
  EXPECT_EQ(soup_of(plain), soup_of(shuffled));
  uint64_t same_place = 0;
  for (uint64_t i = 0; i < plain.vertices(); ++i)
    same_place += plain.vertex(i) == shuffled.vertex(i);
  EXPECT_LT(same_place, plain.vertices() / 20);
}

// Shuffling holds no list, so that the size of a scene does not matter.
TEST(Ply, ShufflingIsTheSameOnEveryRunAndAnotherWithAnotherSeed) {
  const auto mesh = make_scene("terrain", 2'000, 1);
  const auto bytes = [&](uint64_t seed) {
    const TempFolder folder;
    write_ply(*mesh, {.shuffle = true, .seed = seed}, folder.file("a.ply"));
    return folder.read("a.ply");
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST(Ply, AQuarterTurnOfYawIsExact) {
  const auto mesh = make_scene("city", 120, 1);
  const PlyMesh plain = written(*mesh, {}), turned = written(*mesh, {.yaw = 90});
  for (uint64_t i = 0; i < plain.vertices(); ++i) {
    const Point p = plain.vertex(i);
    EXPECT_EQ(turned.vertex(i), Point(p.z, p.y, -p.x));
  }
}

TEST(Scan, IsClosed) {
  const Soup soup = soup_of(*make_scene("scan", 3'000, 1));
  std::map<std::pair<Position, Position>, int> edges;  // directed: each needs its opposite
  for (const auto& t : soup) {
    for (size_t k = 0; k < 3; ++k) {
      const Position &a = t[k], &b = t[(k + 1) % 3];
      ASSERT_NE(a, b);
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
    }
  }
  for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0);
}

TEST(Sheet, IsFlatAndItsNormalIsNoRatioOfSmallIntegers) {
  const auto mesh = make_scene("sheet", 2, 1);
  const auto steps = [&](uint64_t i, int axis) {  // in the units of the file
    return int64_t(mesh->vertex(i)[axis] * 65536);
  };
  int64_t e[2][3], n[3];
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(steps(0, a) + steps(3, a), steps(1, a) + steps(2, a));
    for (uint64_t k = 0; k < 2; ++k) e[k][a] = steps(k + 1, a) - steps(0, a);
  }
  for (int a = 0; a < 3; ++a)
    n[a] = e[0][(a + 1) % 3] * e[1][(a + 2) % 3] - e[0][(a + 2) % 3] * e[1][(a + 1) % 3];
  for (int a = 0; a < 3; ++a) {
    const int64_t b = n[(a + 1) % 3];
    EXPECT_GT(std::abs(n[a]) / std::gcd(n[a], b), 1'000'000);
    EXPECT_GT(std::abs(double(n[a]) / double(b)), 0.4);
    EXPECT_LT(std::abs(double(n[a]) / double(b)), 2.5);
  }
}

TEST(Speck, IsInsideOneVoxelOfTheGridThatTwoFarTrianglesSet) {
  const auto mesh = make_scene("speck", 1'000, 7);
  Box box, speck;
  for (uint64_t i = 0; i < mesh->vertices(); ++i) {
    box.add(mesh->vertex(i));
    if (i >= 6) speck.add(mesh->vertex(i));
  }
  EXPECT_EQ(box.min, Point(-64, -64, -64));
  EXPECT_EQ(box.max, Point(64, 64, 64));
  for (int a = 0; a < 3; ++a) {
    EXPECT_LT(speck.max[a] - speck.min[a], 2 * 1e-6 * 128);
    EXPECT_EQ(std::floor(512 * speck.min[a]), std::floor(512 * speck.max[a]));  // 64K voxels
  }
  EXPECT_GT(soup_of(*mesh).size(), 990u);
}

TEST(Kinds, UnknownNamesAndImpossibleCountsAreUsageErrors) {
  EXPECT_SVDAG_ERROR(make_scene("teapot", 0, 1), ExitCode::kUsage,
                     "\"teapot\" is not a kind of scene");
  EXPECT_SVDAG_ERROR(make_scene("atrium", 100, 1), ExitCode::kUsage, "needs at least");
  EXPECT_SVDAG_ERROR(make_scene("rectangle", 3, 1), ExitCode::kUsage, "2 triangles");
  EXPECT_SVDAG_ERROR(make_scene("sheet", 3, 1), ExitCode::kUsage, "2 triangles");
  EXPECT_SVDAG_ERROR(make_scene("speck", 2, 1), ExitCode::kUsage, "at least 3 triangles");
  EXPECT_SVDAG_ERROR(make_scene("scan", uint64_t(1) << 40, 1), ExitCode::kUsage, "at most");
}

TEST(Numbers, SineIsTheSineAndExactAtQuarters) {
  for (int i = -1000; i <= 1000; ++i) {
    const double turns = i / 97.0;
    EXPECT_NEAR(sin_turns(turns), std::sin(turns * 2 * M_PI), 1e-11);
    EXPECT_NEAR(cos_turns(turns), std::cos(turns * 2 * M_PI), 1e-11);
  }
  for (int i = -8; i <= 8; ++i) {
    EXPECT_EQ(sin_turns(i * 0.25), (std::array{0.0, 1.0, 0.0, -1.0}[size_t(i & 3)]));
    EXPECT_EQ(cos_turns(i * 0.25), (std::array{1.0, 0.0, -1.0, 0.0}[size_t(i & 3)]));
  }
}

RC_GTEST_PROP(Permutation, HitsEachNumberOnceAndKnowsTheWayBack, ()) {
  const auto n = *any_of<uint64_t>(1, 3000);
  const Permutation permutation(n, *rc::gen::arbitrary<uint64_t>());
  std::set<uint64_t> seen;
  for (uint64_t i = 0; i < n; ++i) {
    const uint64_t image = permutation.forward(i);
    RC_ASSERT(image < n);
    RC_ASSERT(permutation.inverse(image) == i);
    seen.insert(image);
  }
  RC_ASSERT(seen.size() == n);
}

}  // namespace
}  // namespace svdag::scenes
