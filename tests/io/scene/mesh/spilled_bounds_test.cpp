// Scene::bounds over spilled positions: the same box bit by bit, the same counts and the same error
// as over positions in memory, and without the join where that is certain.
#include <fstream>

#include "io/scene/scene.h"
#include "tests/io/scene/mesh/test_spill.h"
#include "tests/io/scene/random_mesh.h"

namespace svdag {
namespace {

constexpr uint64_t kShare = 16 * 4096;

struct Bounds {
  std::vector<uint64_t> box;
  uint64_t triangles = 0, invalid = 0;
  std::string error;

  bool operator==(const Bounds&) const = default;
};

Bounds bounds_of(const std::string& path, bool skip_invalid, const SpillSpace* spill) {
  MemoryBudget budget;
  Bounds bounds;
  try {
    SceneCounts counts;
    const Box box = Scene({{path}, {}, skip_invalid}, &budget, spill).bounds(&counts);
    for (const Point& p : {box.min, box.max}) {
      for (int a = 0; a < 3; ++a) bounds.box.push_back(std::bit_cast<uint64_t>(p[a]));
    }
    bounds.triangles = counts.triangles;
    bounds.invalid = counts.invalid;
  } catch (const Error& error) {
    bounds.error = error.what();
  }
  EXPECT_EQ(budget.used(), 0U);
  EXPECT_LE(budget.peak(), spill == nullptr ? budget.limit() : kShare + (1 << 15));
  return bounds;
}

// Returns the bytes that were spilled.
uint64_t expect_same_bounds(const std::string& name, const std::string& bytes) {
  const TempFolder folder;
  const std::string path = folder.write(name, bytes);
  uint64_t written = 0;
  for (const bool skip_invalid : {false, true}) {
    TestSpill spill(kShare);
    const Bounds expected = bounds_of(path, skip_invalid, nullptr);
    const Bounds spilled = bounds_of(path, skip_invalid, spill.space());
    EXPECT_EQ(spilled.error, expected.error);
    EXPECT_TRUE(spilled == expected) << name;
    written = spill.file() == nullptr ? 0 : spill.file()->written_bytes();
  }
  return written;
}

TEST(SpilledBounds, AShareOfLessThanAFewBlocksIsSaid) {
  std::mt19937_64 random(1);
  const TempFolder folder;
  const std::string path = folder.write("a.off", RandomMesh(random, 5000, 9000).off());
  TestSpill spill(4096);
  const Bounds bounds = bounds_of(path, false, spill.space());
  EXPECT_NE(bounds.error.find("raise --memory"), std::string::npos) << bounds.error;
}

TEST(SpilledBounds, RandomMeshesInEveryFormat) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 6; ++round) {
    SCOPED_TRACE(round);
    const uint32_t vertices = 1 + uint32_t(random() % 5000);
    const RandomMesh mesh(random, vertices, random() % 3 == 0 ? 40 : 9000);
    expect_same_bounds("a.obj", mesh.obj(random));
    expect_same_bounds("a.off", mesh.off());
    for (const char* form : {"ascii", "binary_little_endian", "binary_big_endian"})
      expect_same_bounds("a.ply", mesh.ply(random, form));
    expect_same_bounds("cut.off", mesh.off().substr(0, mesh.off().size() * 9 / 10));
  }
}

std::string off(const std::vector<std::string>& vertices, const std::string& faces, int count) {
  std::string text = "OFF\n" + std::to_string(vertices.size()) + " " + std::to_string(count);
  text += " 0\n";
  for (const std::string& v : vertices) text += v + "\n";
  return text + faces;
}

TEST(SpilledBounds, VerticesThatNoTriangleUsesAreOutside) {
  expect_same_bounds("a.off", off({"9 9 9", "0 1 2", "3 4 5", "6 7 9", "nan 0 0", "-9 0 0"},
                                  "3 1 2 3\n2 0 5\n1 0\n", 3));
  expect_same_bounds("strips.ply",
                     "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                     "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                     "end_header\n0 0 0\n1 0 0\n1 1 0\n-7 0 0\n8 0 0\n9 9 9\n"
                     "9 0 1 2 -1 3 3 5 -1 4\n");
}

TEST(SpilledBounds, WhatIsNotFiniteIsRefusedOrDroppedWithItsTriangle) {
  const std::vector<std::string> vertices = {"0 1 2",   "3 4 5",  "6 7 9",
                                             "nan 0 0", "-9 0 0", "inf 0 0"};
  expect_same_bounds("nan.off", off(vertices, "3 0 1 2\n3 1 3 4\n", 2));
  expect_same_bounds("inf.off", off(vertices, "3 0 1 2\n3 5 3 4\n", 2));
  expect_same_bounds("all.off", off(vertices, "3 5 3 4\n", 1));
  std::string many;
  for (int i = 0; i < 5000; ++i) many += "3 1 3 4\n";
  expect_same_bounds("first.off", off(vertices, many + "3 0 1 77\n", 5001));
}

TEST(SpilledBounds, OfZerosOfBothSignsTheEarlierStays) {
  for (const char* faces : {"3 0 1 2\n3 1 2 3\n", "3 3 1 2\n3 1 2 0\n"})
    expect_same_bounds("zero.off", off({"0 1 2", "3 4 -0", "6 -0 -9", "-0 0 0"}, faces, 2));
}

TEST(SpilledBounds, TakeNoJoin) {
  std::mt19937_64 random(2);
  const RandomMesh mesh(random, 5000, 40000);
  EXPECT_LT(expect_same_bounds("a.off", mesh.off()), 5000U * 24 * 3 / 2) << "the positions alone";
}

// What this process has read so far, by any system call.
uint64_t bytes_read() {
  std::ifstream counters("/proc/self/io");
  std::string name;
  uint64_t bytes = 0;
  counters >> name >> bytes;
  return bytes;
}

// A bake reads the bounds and then the triangles. Every pass may read a window too much.
TEST(SpilledBounds, ABakeReadsTheFileAtMostThreeTimes) {
  std::mt19937_64 random(3);
  const RandomMesh mesh(random, 10000, 100000);
  const TempFolder folder;
  const std::string obj = mesh.obj(random);
  for (const std::string& path : {folder.write("a.obj", obj), folder.write("a.off", mesh.off())}) {
    TestSpill spill(kShare);
    MemoryBudget budget;
    const Scene scene({{path}, {}, false}, &budget, spill.space());
    const uint64_t before = bytes_read();
    scene.bounds();
    scene.stream([](const TriangleBatch&) {});
    const uint64_t read = bytes_read() - before - spill.file()->read_bytes();
    EXPECT_LE(read, 33 * File::open_read(path).size() / 10) << path;
  }
}

}  // namespace
}  // namespace svdag
