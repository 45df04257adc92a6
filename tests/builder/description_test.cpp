// What makes two bakes the same one, to the last byte that they read.
#include "builder/description.h"

#include <gtest/gtest.h>

#include <fstream>

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
