// The options of svdag-trace as rays in voxels of the file.
#include "verify/trace/program/trace_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/expect_error.h"
#include "tests/verify/raw_dag.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

TraceOptions parse(std::vector<std::string> words) {
  words.insert(words.begin(), {"svdag-trace", "a.svdag"});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return parse_trace_options(int(argv.size()), argv.data()).value();
}

// 16^3 voxels of side 1/4 with the corner at (-1, 2, 8). Voxels (1, 2, 3) and (9, 10, 11) are set.
PlainFile small_file() {
  Grid grid = test_grid(4);
  grid.voxel_size = 0.25;
  grid.origin = Point(-1, 2, 8);
  const RawFile raw(raw_dag(grid, {{1, 2, 3}, {9, 10, 11}}));
  PlainFile file;
  file.words.resize((raw.bytes().size() + 7) / 8);
  std::memcpy(file.words.data(), raw.bytes().data(), raw.bytes().size());
  file.view = dag_view(file.words.data());
  return file;
}

Workload work_of(const std::vector<std::string>& words) {
  return make_workload(parse(words), small_file());
}

void expect_point(const Vec3& point, double x, double y, double z) {
  EXPECT_DOUBLE_EQ(point[0], x);
  EXPECT_DOUBLE_EQ(point[1], y);
  EXPECT_DOUBLE_EQ(point[2], z);
}

TEST(TraceOptions, OptionsAreInSceneUnitsAndRaysInVoxels) {
  const Workload work =
      work_of({"--camera", "0,3,9,0,3,10", "--light", "1,2.5,8.25,2", "--reach", "3"});
  expect_point(work.picture.camera.position, 4, 4, 4);
  expect_point(work.picture.camera.forward, 0, 0, 1);
  expect_point(work.light.centre, 8, 2, 1);
  EXPECT_DOUBLE_EQ(work.light.radius, 8);
  EXPECT_DOUBLE_EQ(work.secondary.reach, 12);
}

TEST(TraceOptions, ALightWithoutARadiusIsAPoint) {
  EXPECT_EQ(work_of({"--light", "1,2,8"}).light.radius, 0);
}

TEST(TraceOptions, TheDefaultLightIsAboveTheVoxels) {
  const VoxelBounds box = framing_bounds(small_file().view);
  for (int up = 0; up < 3; ++up) {
    const Workload work = work_of({"--up", std::string(1, char('x' + up))});
    for (int a = 0; a < 3; ++a) {
      const double middle = (box.min[a] + box.max[a]) / 2;
      EXPECT_DOUBLE_EQ(work.light.centre[a],
                       middle + (a == up ? 1.5 * (box.max[a] - box.min[a]) : 0));
    }
    EXPECT_DOUBLE_EQ(work.light.radius, 0.02 * length(box.max - box.min));
  }
}

// Inside a room the light is below the ceiling. A camera overrides the preset.
TEST(TraceOptions, OnlyThePresetInsideMovesTheLight) {
  const double above = work_of({}).light.centre[1];
  EXPECT_LT(work_of({"--preset", "inside"}).light.centre[1], above);
  EXPECT_EQ(work_of({"--preset", "top"}).light.centre[1], above);
  EXPECT_EQ(work_of({"--preset", "inside", "--camera", "0,3,9,0,3,10"}).light.centre[1], above);
}

TEST(TraceOptions, PresetsAreThoseOfRender) {
  const PlainFile file = small_file();
  const VoxelBounds box = framing_bounds(file.view);
  for (const std::string name : {"iso", "front", "back", "left", "right", "top", "inside"}) {
    const Camera camera = preset_camera(name, file.view, box, 2, Camera::kDefaultFov, 80.0 / 60);
    const Workload work = work_of({"--preset", name, "--up", "z", "--size", "80x60"});
    const Vec3& at = camera.position;
    expect_point(work.picture.camera.position, at[0], at[1], at[2]);
    EXPECT_DOUBLE_EQ(work.picture.camera.slope, camera.slope);
  }
}

TEST(TraceOptions, TheAngleOfViewIsTheSeventhNumber) {
  const auto slope = [](const std::string& fov) {
    return work_of({"--camera", "0,3,9,0,3,10," + fov}).picture.camera.slope;
  };
  EXPECT_NEAR(slope("90"), 1, 1e-12);
  EXPECT_NEAR(slope("0.1"), std::tan(0.05 * 3.14159265358979323846 / 180), 1e-12);
  EXPECT_GT(slope("179"), 100);
  for (const char* fov : {"0.09", "179.1", "-90"})
    EXPECT_SVDAG_ERROR(slope(fov), ExitCode::kUsage, "is not 0.1 to 179 degrees");
}

TEST(TraceOptions, NumbersReachTheWorkload) {
  const Workload work = work_of(
      {"--size=7x5", "-j3", "--rounds", "2", "--samples", "9", "--no-beams", "--cone", "9"});
  EXPECT_EQ(work.picture.width, 7U);
  EXPECT_EQ(work.picture.height, 5U);
  EXPECT_EQ(work.threads, 3U);
  EXPECT_EQ(work.rounds, 2U);
  EXPECT_EQ(work.secondary.samples, 9U);
  EXPECT_FALSE(work.beams);
  EXPECT_NEAR(work.secondary.cut.spread, 2 * std::tan(0.15707963267948966), 1e-15);
}

TEST(TraceOptions, ByDefaultResultsAreExact) {
  for (const Workload& work : {work_of({}), work_of({"--reach", "0", "--cone", "0"})}) {
    EXPECT_EQ(work.secondary.reach, Secondary().reach);
    EXPECT_EQ(work.secondary.cut.spread, 0);
    EXPECT_TRUE(work.beams);
  }
}

TEST(TraceOptions, InvalidValuesAreUsageErrors) {
  const struct {
    std::vector<std::string> words;
    const char* sentence;
  } cases[] = {
      {{"--sise"}, "unknown option --sise of svdag-trace; did you mean --size?"},
      {{"-x"}, "unknown option -x of svdag-trace"},
      {{"-5"}, "unexpected argument: -5"},
      {{"--size"}, "--size: the value is missing"},
      {{"--size="}, "--size: the value is empty"},
      {{"--size", "4"}, "is not WIDTHxHEIGHT"},
      {{"--size", "0x4"}, "with 1 to 16384 pixels each"},
      {{"--size", "4x4", "--size", "8x8"}, "--size: is given more than once"},
      {{"-j", "2", "--threads", "3"}, "--threads: is given more than once"},
      {{"--device", "gpu"}, "\"gpu\" is not one of cpu, cuda"},
      {{"--up", "w"}, "\"w\" is not one of x, y, z"},
      {{"--camera", "0,3,9,0,3,10", "--preset", "low"}, "\"low\" is not one of iso, front"},
      {{"--camera", "1,2,3"}, "give px,py,pz,tx,ty,tz"},
      {{"--camera", "1,2,3,1,2,3"}, "are one point"},
      {{"--camera", "1e400,2,3,1,2,3"}, "is not a list of finite numbers"},
      {{"--camera", "1e300,2,3,1,2,3"}, "more than 10^100 voxels away"},
      {{"--light", "1,2"}, "give x,y,z"},
      {{"--light", "1,2,3,-1"}, "the radius 0 or more"},
      {{"--cone", "45"}, "--cone: \"45\""},
      {{"--reach", "-1"}, "--reach: \"-1\""},
      {{"b.svdag"}, "unexpected argument: b.svdag"},
      {{"--", "-b"}, "unexpected argument: -b"},
  };
  for (const auto& [words, sentence] : cases)
    EXPECT_SVDAG_ERROR(work_of(words), ExitCode::kUsage, sentence);
}

TEST(TraceOptions, PictureNamesOfOtherFormatsAreRejectedInAnyCase) {
  for (const char* ending :
       {"png", "PNG", "jpg", "jpeg", "webp", "gif", "bmp", "tif", "tiff", "exr"})
    EXPECT_SVDAG_ERROR(parse({"--picture", std::string("a.") + ending}), ExitCode::kUsage,
                       "pictures are PPM");
  for (const char* name : {"a.ppm", "a", "png"})
    EXPECT_EQ(parse({"--picture", name}).picture, name);
}

}  // namespace
}  // namespace svdag
