// Figure: a person of turned limbs with a skeleton of 13 joints, and two steps of a walk as an
// animation: what a skinned mesh needs, in one file.
#include <algorithm>

#include "tests/scenes/kinds.h"
#include "tests/scenes/masonry.h"
#include "tests/scenes/rig.h"

namespace svdag::scenes {
namespace {

enum JointNumber { kHips, kChest, kHead, kLeft };  // from kLeft on kLimbJoints of each side
enum LimbJoint { kUpperArm, kForearm, kThigh, kShin, kFoot, kLimbJoints };
constexpr double kHipHeight = 0.92, kWaist = 1.06, kNeck = 1.44;
constexpr double kShoulder = 1.38, kElbow = 1.10, kKnee = 0.50, kAnkle = 0.09;
constexpr double kArmX = 0.22, kLegX = 0.10;
constexpr int kTimes = 16;  // of a period of one second

size_t joint_of(int side, LimbJoint joint) {
  return size_t(kLeft + side * kLimbJoints + joint);
}

// About the x axis, to which the figure's right points; a positive turn moves what hangs backwards.
Quaternion turned_about_x(double turns) {
  return {sin_turns(turns / 2), 0, 0, cos_turns(turns / 2)};
}
Quaternion turned_about_y(double turns) {
  return {0, sin_turns(turns / 2), 0, cos_turns(turns / 2)};
}

Rig walk() {
  Rig rig{"walk",
          {},
          {{"hips", 0, {0, kHipHeight, 0}, {}},
           {"chest", kHips, {0, kWaist, 0}, {}},
           {"head", kChest, {0, kNeck, 0}, {}}}};
  for (const double x : {-1.0, 1.0}) {
    const bool left = x > 0;
    const size_t arm = rig.joints.size(), thigh = arm + kThigh;
    rig.joints.push_back({left ? "left arm" : "right arm", kChest, {x * kArmX, kShoulder, 0}, {}});
    rig.joints.push_back(
        {left ? "left forearm" : "right forearm", arm, {x * kArmX, kElbow, 0}, {}});
    rig.joints.push_back(
        {left ? "left thigh" : "right thigh", kHips, {x * kLegX, kHipHeight, 0}, {}});
    rig.joints.push_back({left ? "left shin" : "right shin", thigh, {x * kLegX, kKnee, 0}, {}});
    rig.joints.push_back(
        {left ? "left foot" : "right foot", thigh + 1, {x * kLegX, kAnkle, 0}, {}});
  }
  for (int i = 0; i <= kTimes; ++i) {
    const double time = double(i) / kTimes;
    rig.times.push_back(time);
    rig.joints[kHips].turns.push_back(turned_about_y(0.012 * sin_turns(time)));
    rig.joints[kChest].turns.push_back(turned_about_y(-0.03 * sin_turns(time)));
    for (int side = 0; side < 2; ++side) {
      const double phase = time + 0.5 * side;  // the sides take turns
      const double swing = sin_turns(phase), lift = std::max(0.0, cos_turns(phase + 0.05));
      const auto turn = [&](LimbJoint joint, double turns) {
        rig.joints[joint_of(side, joint)].turns.push_back(turned_about_x(turns));
      };
      turn(kUpperArm, 0.075 * swing);
      turn(kForearm, -0.05 + 0.03 * swing);
      turn(kThigh, -0.02 - 0.075 * swing);
      turn(kShin, 0.015 + 0.15 * lift * lift);
      turn(kFoot, 0.02 * swing - 0.04 * lift);
    }
  }
  return rig;
}

class Figure : public PatchMesh {
 public:
  Figure(std::vector<Patch> patches, uint64_t triangles)
      : PatchMesh(std::move(patches), triangles), rig_(walk()) {}

  const Rig* rig() const override { return &rig_; }

  Grip grip(uint64_t i) const override {
    const std::string part = place(i).patch.part;
    const Point p = vertex(i);
    if (part == "head") return {kHead};
    if (part == "body") return between(kChest, kHips, p.y, kWaist, 0.08);
    const int side = p.x > 0 ? 1 : 0;
    if (part == "arm")
      return between(joint_of(side, kUpperArm), joint_of(side, kForearm), p.y, kElbow, 0.05);
    if (part == "shoe") return {joint_of(side, kFoot)};
    return between(joint_of(side, kThigh), joint_of(side, kShin), p.y, kKnee, 0.07);
  }

 private:
  // From one joint to the one below it, around the height of the second.
  static Grip between(size_t upper, size_t lower, double y, double height, double reach) {
    return {upper, lower, std::clamp((height + reach - y) / (2 * reach), 0.0, 1.0)};
  }

  Rig rig_;
};

// The profile with two more points between each two: a Catmull-Rom spline.
Profile rounded(const Profile& profile) {
  Profile result{profile.front()};
  for (size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto [r0, y0] = profile[i > 0 ? i - 1 : 0];
    const auto [r1, y1] = profile[i];
    const auto [r2, y2] = profile[i + 1];
    const auto [r3, y3] = profile[std::min(i + 2, profile.size() - 1)];
    for (const double t : {1 / 3.0, 2 / 3.0, 1.0}) {
      const auto spline = [t](double a, double b, double c, double d) {
        return b + t / 2 * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
      };
      result.emplace_back(std::max(0.0, spline(r0, r1, r2, r3)), spline(y0, y1, y2, y3));
    }
  }
  return result;
}

}  // namespace

std::unique_ptr<Mesh> make_figure(uint64_t triangles, uint64_t seed) {
  Masonry m;
  const double girth = 0.92 + 0.16 * uniform(seed, 0);
  // Around a vertical axis, `depth` times as deep as wide.
  const auto limb = [&](const Point& foot, double depth, const Profile& profile) {
    m.turned({foot, {1, 0, 0}, {0, 0, depth}}, rounded(profile));
  };
  m.part("head", "skin");
  limb({0, 0, 0}, 1, {{0.062, 1.39}, {0.052, 1.44}, {0.055, 1.5}});
  limb({0, 0, 0.01}, 1.12,
       {{0, 1.47},
        {0.045, 1.48},
        {0.074, 1.54},
        {0.086, 1.61},
        {0.08, 1.69},
        {0.05, 1.735},
        {0, 1.75}});
  m.part("head", "hair");
  limb({0, 0, -0.012}, 1.1,
       {{0.06, 1.54}, {0.09, 1.59}, {0.096, 1.66}, {0.082, 1.72}, {0.05, 1.755}, {0, 1.768}});
  m.part("body", "shirt");
  limb({0, 0, 0}, 0.62 * girth,
       {{0.164, 0.9},
        {0.158, 0.98},
        {0.148, 1.08},
        {0.172, 1.22},
        {0.205, 1.34},
        {0.19, 1.4},
        {0.12, 1.445},
        {0.05, 1.47}});
  m.part("body", "trousers");
  limb({0, 0, 0}, 0.7 * girth, {{0, 0.82}, {0.09, 0.83}, {0.15, 0.88}, {0.165, 0.93}, {0.155, 1}});
  for (const double x : {-1.0, 1.0}) {
    m.part("arm", "shirt");
    limb({x * kArmX, 0, 0}, 1,
         {{0.05, 1.14}, {0.052, 1.24}, {0.06, 1.33}, {0.054, 1.39}, {0.03, 1.42}, {0, 1.43}});
    m.part("arm", "skin");
    limb({x * kArmX, 0, 0}, 1,
         {{0, 0.71},
          {0.026, 0.72},
          {0.04, 0.76},
          {0.036, 0.81},
          {0.027, 0.86},
          {0.038, 1},
          {0.04, 1.1},
          {0.042, 1.2}});
    m.part("leg", "trousers");
    limb({x * kLegX, 0, 0}, 1,
         {{0.055, 0.07},
          {0.06, 0.22},
          {0.066, 0.36},
          {0.064, 0.5},
          {0.082, 0.7},
          {0.092, 0.84},
          {0.07, 0.92},
          {0, 0.95}});
    m.part("shoe", "shoe");
    limb({x * kLegX, 0, 0.055}, 2.3,
         {{0, 0}, {0.045, 0}, {0.056, 0.02}, {0.05, 0.06}, {0.03, 0.09}, {0, 0.1}});
  }
  return std::make_unique<Figure>(m.take(), triangles);
}

}  // namespace svdag::scenes
