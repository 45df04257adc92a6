// What makes two bakes the same one, to the last byte that they read.
#include "builder/bake/description.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/builder/bakes.h"
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
