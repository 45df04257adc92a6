#include "io/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/scene/scene_formats.h"
#include "streaming/error.h"
#include "tests/shared_scenes.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// Files in a folder that goes with the test.
class SceneFiles : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }
  std::string triangle_obj(const std::string& name, const std::string& x) const {
    return write(name, "v " + x + " 0 0\nv 1 0 0\nv 1 2 3\nv 9 9 9\nf 1 2 3\n");
  }
  SceneCounts stream(const SceneConfig& config) {
    return Scene(config, &budget_).stream([](const TriangleBatch&) {});
  }
  std::string refusal(const SceneConfig& config, ExitCode code = ExitCode::kBadInput) {
    try {
      stream(config);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      return error.what();
    }
    ADD_FAILURE() << "was read";
    return {};
  }

  TempFolder folder_;
  MemoryBudget budget_;
};

TEST_F(SceneFiles, SeveralFilesAreOneScene) {
  const SceneConfig config{{triangle_obj("a.obj", "-5"), triangle_obj("b.obj", "7")}, {}, false};
  SceneCounts counts;
  const Box box = Scene(config, &budget_).bounds(&counts);
  EXPECT_EQ(counts.triangles, 2U);
  EXPECT_EQ(box.min, Point(-5, 0, 0));
  EXPECT_EQ(box.max, Point(7, 2, 3)) << "the vertex 9 9 9 is used by no triangle";
}

TEST_F(SceneFiles, FilesAreChosenByName) {
  const std::vector<std::string> paths = {triangle_obj("a.obj", "1"), triangle_obj("b.obj", "2")};
  EXPECT_EQ(stream({paths, {{"a.obj"}, {}}, false}).triangles, 1U);
  EXPECT_EQ(stream({paths, {{}, {"*.obj"}}, false}).triangles, 0U);
  EXPECT_NE(refusal({paths, {{"c.obj"}, {}}, false}, ExitCode::kUsage).find("file:a.obj"),
            std::string::npos);
  SceneConfig none{paths, {{"c.obj"}, {}}, false};
  none.allow_unmatched = true;
  EXPECT_EQ(stream(none).triangles, 0U);
}

TEST_F(SceneFiles, CoordinatesThatAreNotFiniteAreRefusedOrSkippedAndCounted) {
  for (const char* x : {"nan", "inf", "-inf", "1e999"}) {
    const std::string path = triangle_obj("bad.obj", x);
    EXPECT_NE(refusal({{path}, {}, false}).find("triangle 0"), std::string::npos);
    const SceneCounts counts = stream({{path}, {}, true});
    EXPECT_EQ(counts.triangles, 0U);
    EXPECT_EQ(counts.invalid, 1U);
  }
}

// The check of a whole batch at once may not see an infinity where only its own sum overflows, and
// may not miss one in any place.
TEST_F(SceneFiles, HugeCoordinatesAreFiniteAndOneInfinityIsFoundAnywhere) {
  const std::string huge = "v 1.7e308 1.7e308 -1.7e308\n";
  EXPECT_EQ(stream({{write("huge.obj", huge + huge + huge + "f 1 2 3\n")}, {}, false}).triangles,
            1U);
  for (int place = 0; place < 9; ++place) {
    std::string text;
    for (int i = 0; i < 9; ++i)
      text += std::string(i % 3 == 0 ? "\nv " : " ") + (i == place ? "-inf" : "1");
    text += "\nv inf 0 0\nv 0 0 0\nf 5 5 5\nf 1 2 3\nf 5 5 5\n";
    const std::string path = write("place.obj", text);
    EXPECT_NE(refusal({{path}, {}, false}).find("triangle 1"), std::string::npos) << place;
    EXPECT_EQ(stream({{path}, {}, true}).invalid, 1U) << place;
  }
  const std::string opposite = "v inf 0 0\nv -inf 0 0\nv 0 0 0\nf 1 2 3\n";
  EXPECT_EQ(stream({{write("opposite.obj", opposite)}, {}, true}).invalid, 1U);
}

TEST_F(SceneFiles, ASceneWithoutTrianglesHasNoBounds) {
  const std::string path = write("points.obj", "v 0 0 0\n");
  EXPECT_THROW(Scene({{path}, {}, false}, &budget_).bounds(), Error);
}

TEST_F(SceneFiles, UnknownAndMissingFilesAreRefused) {
  EXPECT_NE(refusal({{write("a.txt", "hello")}, {}, false}).find("not a supported scene file"),
            std::string::npos);
  EXPECT_NE(refusal({{folder_.file("none.ply")}, {}, false}).find("no such file"),
            std::string::npos);
  EXPECT_NE(refusal({{folder_.path()}, {}, false}).find("is a folder"), std::string::npos);
}

TEST_F(SceneFiles, TheFormatIsToldByContentBeforeTheExtension) {
  const auto format = [&](const std::string& name, const std::string& text) {
    return std::string(detect_format(File::open_read(write(name, text))).name);
  };
  EXPECT_EQ(format("a.obj", "ply\nformat"), "PLY");
  EXPECT_EQ(format("a.stl", "glTF\2\0\0\0"), "GLB");
  EXPECT_EQ(format("a", "DRACO\2\2"), "Draco");
  EXPECT_EQ(format("a.STL", "anything"), "STL");
  EXPECT_EQ(format("a.stl", "plyconv output"), "STL");
  EXPECT_EQ(format("a.stl", "glTF to STL"), "STL");
  EXPECT_EQ(format("a.stl", "ply to stl converter"), "STL");
  EXPECT_EQ(format("a.stl", "DRACO to STL"), "STL");
  EXPECT_EQ(format("a.stl", "ply\nformat"), "PLY");
  EXPECT_EQ(format("a", "\xEF\xBB\xBFOFF\n"), "OFF");
  EXPECT_EQ(format("a.Obj", "solid"), "OBJ");
  EXPECT_EQ(format("a", "OFF\n"), "OFF");
  EXPECT_EQ(format("a", "solid x"), "STL");
  EXPECT_EQ(format("a", "Kaydara FBX Binary"), "FBX");
  EXPECT_EQ(format("a.DAE.gz", "<?xml"), "COLLADA");
  EXPECT_EQ(format("a.3mf", "PK"), "3MF");
  EXPECT_EQ(format("a.3ds", "MM"), "3DS");
}

// The counts and boxes that were made with other software (six significant digits).
struct Known {
  const char* file;
  uint64_t triangles;
  Point min, max;
};
const Known kKnown[] = {
    {"cgal_boeing.off", 2564, {-6, -12, -2.5}, {6, 12, 2.5}},
    {"cgal_elephant-with-holes.off", 4463, {-0.360217, -0.5, -0.301481}, {0.360217, 0.5, 0.301481}},
    {"cgal_polygon_mesh.off", 32245, {-344.389, -150.786, 35.9661}, {-208.689, -15.7582, 48.0643}},
    {"cgal_refined_elephant.off",
     88928,
     {-0.358822, -0.499404, -0.300133},
     {0.358436, 0.497472, 0.299583}},
    {"openfoam_buildings.stl", 400020, {8.19019, 18.6039, 0}, {237.283, 158.66, 76}},
    {"openfoam_motorbike.obj",
     331653,
     {-0.291665, -0.350289, -4.232e-05},
     {1.75115, 0.332267, 1.35152}},
    {"openfoam_terrain_utm.stl", 21186, {581311, 4785270, 937.3}, {582301, 4786340, 1044.6}},
    {"samurai_monastery.obj", 124789, {-69.6893, -0.020004, -61.5423}, {54.8414, 30.3412, 59.4612}},
    {"stanford_dragon.ply",
     871414,
     {-0.108324, 0.0527295, -0.0504143},
     {0.0965662, 0.197173, 0.0412075}},
    {"thingi10k_39202.stl", 16962, {-25, -43.3013, 0}, {50, 43.3013, 99.8464}},
    {"thingi10k_472042.stl", 3632, {0, 5.10079, 2.70121}, {91.4401, 187.928, 93.2211}},
    {"thingi10k_73416.stl", 76840, {-27.75, -22, 0}, {27.75, 22, 18.9748}}};

TEST(SharedScenes, CountsAndBoxesAreTheKnownOnes) {
  SVDAG_NEEDS_SHARED_SCENES();
  for (const Known& known : kKnown) {
    SCOPED_TRACE(known.file);
    MemoryBudget budget;
    SceneCounts counts;
    const Box box = Scene({{shared_scene(known.file)}, {}, false}, &budget).bounds(&counts);
    EXPECT_EQ(counts.triangles, known.triangles);
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(box.min[a], known.min[a], 6e-6 * std::abs(known.min[a]));
      EXPECT_NEAR(box.max[a], known.max[a], 6e-6 * std::abs(known.max[a]));
    }
  }
}

}  // namespace
}  // namespace svdag
