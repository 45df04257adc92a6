// Poses at a time, by the formulas of the specification; trigonometry beside the C library's.
#include "io/scene/gltf/gltf_animation.h"

#include <gmock/gmock.h>

#include <cmath>

#include "io/trigonometry.h"
#include "tests/io/scene/gltf/gltf_builder.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Animated : public testing::Test {
 protected:
  Animated() { gltf_.show(gltf_.mesh(gltf_.accessor(kTriangle, "VEC3"))); }

  void animate(const char* path, const std::vector<float>& times, const std::vector<float>& values,
               const char* how = "LINEAR", int node = 0, const char* name = "move") {
    const std::string kind = path;
    const char* type = kind == "rotation" ? "VEC4" : kind == "weights" ? "SCALAR" : "VEC3";
    gltf_.append("animations",
                 {{"name", name},
                  {"samplers",
                   {{{"input", gltf_.accessor(times, "SCALAR")},
                     {"output", gltf_.accessor(values, type)},
                     {"interpolation", how}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
  }
  // The corners at a time.
  CornerList at(double seconds, const std::string& animation = "all") {
    const TempFolder folder;
    MemoryBudget budget;
    const NameFilter names;
    const PoseTime time{seconds, animation};
    ReadOptions options{&names, false, &budget};
    options.time = &time;
    CornerList corners;
    const File file = File::open_read(folder.write("a.glb", gltf_.glb()));
    read_meshes(read_gltf, file, options, [&](const TriangleBatch& batch) {
      for (const Point& p : batch.triangles[0].v) corners.push_back({p.x, p.y, p.z});
    });
    return corners;
  }
  // The first corner, which is the node's translation.
  std::array<double, 3> first_at(double seconds, const std::string& animation = "all") {
    return at(seconds, animation)[0];
  }
  std::string failure_at(double seconds, const std::string& animation = "all") {
    try {
      at(seconds, animation);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  GltfBuilder gltf_;
};
using P3 = std::array<double, 3>;

TEST_F(Animated, LinearAndStepClampAtTheirEnds) {
  animate("translation", {1, 2, 4}, {0, 0, 0, 8, 0, 0, 8, 4, 0});
  EXPECT_EQ(first_at(-5), (P3{0, 0, 0}));
  EXPECT_EQ(first_at(1.25), (P3{2, 0, 0}));
  EXPECT_EQ(first_at(2), (P3{8, 0, 0}));
  EXPECT_EQ(first_at(3), (P3{8, 2, 0}));
  EXPECT_EQ(first_at(99), (P3{8, 4, 0}));
  gltf_.json["animations"][0]["samplers"][0]["interpolation"] = "STEP";
  EXPECT_EQ(first_at(1.99), (P3{0, 0, 0}));
  EXPECT_EQ(first_at(2), (P3{8, 0, 0}));
}

// In-tangent, value, out-tangent of two keys, two seconds apart.
TEST_F(Animated, CubicSplines) {
  animate("translation", {0, 2}, {0, 0, 0, 0, 0, 0, 4, 0, 0, 8, 0, 0, 16, 0, 0, 0, 0, 0},
          "CUBICSPLINE");
  for (const double t : {0.0, 0.5, 1.0, 1.75, 2.0}) {
    const double u = t / 2, u2 = u * u, u3 = u2 * u;
    const double x = (-2 * u3 + 3 * u2) * 16 + 2 * (u3 - 2 * u2 + u) * 4 + 2 * (u3 - u2) * 8;
    EXPECT_NEAR(first_at(t)[0], t == 2 ? 16 : x, 1e-12) << t;
  }
}

TEST_F(Animated, RotationsTakeTheShortWay) {
  const float h = float(std::sqrt(0.5));
  animate("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h});  // a quarter turn around z
  for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const CornerList corners = at(t);
    const double angle = t * std::acos(-1.0) / 2;
    EXPECT_NEAR(corners[1][0], std::cos(angle), 1e-7) << t;
    EXPECT_NEAR(corners[1][1], std::sin(angle), 1e-7) << t;
  }
}

TEST_F(Animated, ScaleAndWeightsOfMorphTargets) {
  animate("scale", {0, 1}, {1, 1, 1, 3, 1, 1});
  EXPECT_EQ(at(0.5)[1], (P3{2, 0, 0}));
  json& primitive = gltf_.json["meshes"][0]["primitives"][0];
  const int up = gltf_.accessor(std::vector<float>{0, 0, 8, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int right = gltf_.accessor(std::vector<float>{4, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  primitive["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  animate("weights", {0, 1}, {0, 0, 1, 0.5f});
  EXPECT_EQ(first_at(0.5), (P3{2 * 4 * 0.25, 0, 4}));
}

TEST_F(Animated, OneOfSeveralByNameOrNumber) {
  animate("translation", {0}, {1, 0, 0}, "LINEAR", 0, "one");
  animate("translation", {0}, {2, 0, 0}, "LINEAR", 0, "two");
  EXPECT_EQ(first_at(0, "one"), (P3{1, 0, 0}));
  EXPECT_EQ(first_at(0, "#1"), (P3{2, 0, 0}));
  EXPECT_EQ(first_at(0, "all"), (P3{2, 0, 0}));
  EXPECT_THAT(failure_at(0, "three"), HasSubstr("has only these: one, two"));
}

TEST_F(Animated, BrokenAnimationsAreRefused) {
  EXPECT_THAT(failure_at(0), HasSubstr("has no animations"));
  animate("translation", {0, 1, 1}, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_THAT(failure_at(0), HasSubstr("do not ascend"));
  gltf_.json.erase("animations");
  animate("translation", {0, 1}, {0, 0, 0});
  EXPECT_THAT(failure_at(0), HasSubstr("do not belong to its times"));
  gltf_.json.erase("animations");
  animate("translation", {0}, {0, 0, 0}, "SPLINE");
  EXPECT_THAT(failure_at(0), HasSubstr("unknown interpolation"));
  gltf_.json.erase("animations");
  animate("translation", {0}, {0, 0, 0}, "STEP", 7);
  EXPECT_THAT(failure_at(0), HasSubstr("nodes[7]"));
  gltf_.json.erase("animations");
  animate("translation", {0}, {0, 0, 0});
  gltf_.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(failure_at(0), HasSubstr("which has a matrix"));
}

TEST(Trigonometry, IsWithinTwoRoundings) {
  for (int i = 0; i <= 4000; ++i) {
    const double x = 1.6 * i / 4000, d = 0.999 * i / 4000;
    EXPECT_NEAR(sine(x), std::sin(x), 4e-16);
    EXPECT_NEAR(cosine(x), std::cos(x), 4e-16);
    EXPECT_NEAR(arc_cosine(d), std::acos(d), 4e-15 / std::sqrt(1 - d * d));
    EXPECT_NEAR(fifth_root(0.001 + d), std::pow(0.001 + d, 0.2), 4e-16);
  }
}

TEST(Trigonometry, AnglesMayBeOfAnySize) {
  for (double x = 1e-9; x < 1e6; x *= 1.001) {
    for (const double angle : {x, -x}) {
      EXPECT_NEAR(sine_of_angle(angle), std::sin(angle), 1e-15) << angle;
      EXPECT_NEAR(cosine_of_angle(angle), std::cos(angle), 1e-15) << angle;
    }
  }
  for (const double angle : {1e12, 1e300, HUGE_VAL, -HUGE_VAL, double(NAN)})
    EXPECT_LE(std::abs(sine_of_angle(angle)), 1) << angle;
}

}  // namespace
}  // namespace svdag
