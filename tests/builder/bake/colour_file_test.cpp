// Colours for a `.svdag`: of which scene, placed how, and what is refused.
#include "builder/colour_file.h"

#include <gtest/gtest.h>

#include "streaming/error.h"
#include "tests/builder/bakes.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class ColourFile : public testing::Test {
 protected:
  ColourFile() {
    write_stl(path("scene.stl"), bumpy_sphere(20));
    build_.scene.paths = {path("scene.stl")};
    build_.output = path("plain.svdag");
    build_.levels = 5;
    config_.file = build_.output;
    config_.scene = build_.scene;
    config_.output = path("coloured.svdag");
  }

  std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

  // "LEVEL: N entries", or the error.
  std::string colour() {
    SequentialExecutor executor;
    Progress progress;
    std::string log;
    try {
      const ColourReport report = colour_file(config_, &executor, &progress);
      EXPECT_EQ(DagFile::open(config_.output).grid().levels, 5);
      log = std::to_string(report.level) + ": " + std::to_string(report.entries) + " entries";
    } catch (const Error& error) {
      return error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(path("coloured.svdag.scratch")));
    return log;
  }

  TempFolder folder_;
  BuildConfig build_;
  ColourFileConfig config_;
};

TEST_F(ColourFile, ASceneOfOneColourIsOneEntryAtTheLevelOfVoxels) {
  bake(build_);
  EXPECT_EQ(colour(), "5: 1 entries");
  config_.pass.level = 3;
  EXPECT_EQ(colour(), "3: 1 entries");
}

TEST_F(ColourFile, TheLevelIsOneOfTheGrid) {
  bake(build_);
  for (const int level : {2, 6}) {
    config_.pass.level = level;
    EXPECT_NE(colour().find("--colour-level " + std::to_string(level) + ": choose 3 to 5"),
              std::string::npos);
  }
}

TEST_F(ColourFile, TheScenesPlaceIsThatOfTheFile) {
  build_.scene.scale = 1.0 / 3;
  build_.scene.up.m[0][0] = -1;
  bake(build_);
  config_.scene.up = build_.scene.up;
  EXPECT_NE(colour().find("--transform, --up, --scale"), std::string::npos);
  config_.scene = build_.scene;
  EXPECT_EQ(colour(), "5: 1 entries");
  config_.scene.scale = 1;
  config_.scene.up = Affine();
  EXPECT_EQ(colour(), "5: 1 entries");
}

TEST_F(ColourFile, AFileWithoutAUnionIsRefused) {
  build_.layers = LayerKind::kFile;
  build_.with_union = false;
  bake(build_);
  EXPECT_NE(colour().find("has no union"), std::string::npos);
  build_.with_union = true;
  bake(build_);
  EXPECT_EQ(colour(), "5: 1 entries");
}

TEST_F(ColourFile, AnotherSceneIsRefused) {
  bake(build_);
  write_stl(path("scene.stl"), {{{Point(0), Point(1, 0, 0), Point(0, 1, 0)}}});
  EXPECT_NE(colour().find("does not belong to this scene"), std::string::npos);
}

}  // namespace
}  // namespace svdag
