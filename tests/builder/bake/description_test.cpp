// What makes two bakes the same one, to the last byte that they read.
#include "builder/bake/description.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/builder/bakes.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string described(const BuildConfig& config) {
  MemoryBudget budget(uint64_t(64) << 20);
  return describe(config, scene_files(Scene(config.scene, &budget)));
}

TEST(Description, HoldsTheGridTheRuleAndTheParts) {
  const TempFolder folder;
  write(folder.file("scene.obj"), "v 0 0 0\n");
  const BuildConfig config = config_for(folder.file("scene.obj"), "out.svdag", 8);
  const std::string said = described(config);
  EXPECT_EQ(difference(said, described(config)), "");
  BuildConfig other = config;
  other.levels = 9;
  EXPECT_NE(difference(said, described(other)), "");
  other = config;
  other.scene.names.exclude = {"roof"};
  EXPECT_NE(difference(said, described(other)), "");
  other = config;
  other.memory = uint64_t(1) << 30;
  other.output = "elsewhere.svdag";
  EXPECT_EQ(difference(said, described(other)), "");
  other = config;
  other.open_as_sheets = true;
  EXPECT_NE(difference(said, described(other)), "");
}

// A pass over a file in its order leaves nothing to read for the hash.
TEST(Description, HashesThatReadersMadeAreThoseOfTheFiles) {
  const TempFolder folder;
  MemoryBudget budget(uint64_t(64) << 20);
  const auto soup = random_soup(3000, 0.1, 1);
  for (const char* name : {"scene.stl", "scene.obj", "scene.stl.gz"}) {
    const std::string path = folder.file(name);
    if (path.ends_with(".obj")) {
      write(path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# the end\n");
    } else {
      write_stl(folder.file("scene.stl"), soup);
      if (path.ends_with(".gz")) {
        ASSERT_EQ(std::system(("gzip -kf " + folder.file("scene.stl")).c_str()), 0);
      }
    }
    SceneConfig config;
    config.paths = {path};
    Scene scene(config, &budget);
    const std::string expected = scene_files(scene).at(0).hash;
    ContentHashes hashes;
    scene.hash_reads(&hashes);
    scene.bounds();
    EXPECT_EQ(hashes.at(path).size(), std::filesystem::file_size(path)) << name;
    scene.stream([](const TriangleBatch&) {});
    EXPECT_EQ(scene_files(scene, std::move(hashes)).at(0).hash, expected) << name;
  }
}

TEST(Description, PatternsAreNeverMistakenForOthers) {
  const TempFolder folder;
  write(folder.file("scene.obj"), "v 0 0 0\n");
  BuildConfig config = config_for(folder.file("scene.obj"), "out.svdag", 8);
  const std::vector<std::vector<std::string>> lists = {
      {}, {""}, {"a b"}, {"a", "b"}, {"a\" \"b"}, {"a\\", "b"}, {"a\\\" \"b"}, {"a\nb"}, {"a\\nb"}};
  std::set<std::string> texts;
  for (const auto& patterns : lists) {
    config.scene.names.include = patterns;
    EXPECT_TRUE(texts.insert(described(config)).second);
  }
  config.scene.names.include = {"a b", "roof"};
  EXPECT_NE(described(config).find("included parts: \"a b\" roof\n"), std::string::npos);
}

TEST(Description, ANameOfAFileStaysOnItsLine) {
  const TempFolder folder;
  const BuildConfig config;
  const std::vector<SceneFile> one = {{"x/a: 1\ncontent of b", 0, "2"}};
  const std::vector<SceneFile> two = {{"x/a", 0, "1"}, {"x/b", 0, "2"}};
  EXPECT_NE(describe(config, one), describe(config, two));
}

TEST(Description, HoldsTheBuffersThatASceneNames) {
  const TempFolder folder;
  write(folder.file("scene.gltf"), R"({"asset": {"version": "2.0"}, "buffers": [
      {"uri": "first.bin", "byteLength": 3}, {"uri": "missing.bin", "byteLength": 3},
      {"uri": "data:application/octet-stream;base64,AAAA", "byteLength": 3}]})");
  write(folder.file("first.bin"), "abc");
  const BuildConfig config = config_for(folder.file("scene.gltf"), "out.svdag", 8);
  const std::string said = described(config);
  EXPECT_NE(said.find("content of first.bin"), std::string::npos) << said;
  write(folder.file("first.bin"), "abd");
  EXPECT_NE(difference(said, described(config)).find("first.bin"), std::string::npos);
}

}  // namespace
}  // namespace svdag
