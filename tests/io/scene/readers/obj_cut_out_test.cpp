#include "io/scene/readers/obj_cut_out.h"

#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/io/scene/mesh/test_spill.h"
#include "tests/io/scene/png_file.h"

namespace svdag {
namespace {

// A triangle that is cut out.
struct Cut {
  Triangle triangle;
  TextureCorners texture;
  CutOut cut;
};

class ObjCut : public testing::Test {
 protected:
  // RGBA: alpha 255, 0 above 0, 200. Grey: 10 to 40.
  ObjCut() {
    std::string rgba;
    for (const int alpha : {255, 0, 0, 200}) rgba += rgb(9, 9, 9) + char(alpha);
    folder_.write("rgba.png", png(2, 2, PngKind::kRgba, rgba));
    folder_.write("grey.png", png(2, 2, PngKind::kGrey, {10, 20, 30, 40}));
    folder_.write("rgb.png", png(1, 1, PngKind::kRgb, rgb(100, 200, 50)));
  }

  // Reads faces of material m.
  std::vector<Cut> cuts(const std::string& statements, const std::string& faces,
                        const SpillSpace* spill = nullptr) {
    folder_.write("a.mtl", "newmtl m\n" + statements);
    const File file = File::open_read(
        folder_.write("a.obj",
                      "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 1 1 0\nv 0 4 0\nvt 0 0\nvt 4 0\n"
                      "vt 4 4\nvt 1 1\nvt 0 4 7\nusemtl m\n" +
                          faces));
    AlphaImages images(&budget_, false);
    ReadOptions options{&names_, false, &budget_, spill};
    options.alpha = &images;
    std::vector<Cut> found;
    whole_ = 0;
    left_out_ = read_meshes(read_obj, file, options, [&](const TriangleBatch& batch) {
      for (size_t i = 0; i < batch.triangles.size(); ++i) {
        batch.cut == nullptr ? void(++whole_)
                             : found.push_back({batch.triangles[i], batch.texture[i], *batch.cut});
      }
    });
    return found;
  }

  TempFolder folder_;
  MemoryBudget budget_;
  NameFilter names_;
  uint64_t whole_ = 0;  // triangles
  LeftOut left_out_;
};

// Coordinates are x and y.
void expect_in_place(const std::vector<Cut>& cuts) {
  for (const Cut& c : cuts) {
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(c.texture[i].u, c.triangle.v[i].x * 2);
      EXPECT_EQ(c.texture[i].v, (1 - c.triangle.v[i].y) * 2) << "the first row is at the top";
    }
  }
}

constexpr const char* kConcave = "f 1/1 2/2/1 3/3 4/4 5/5\nf 1/1 2/2 3/3\nf -5/-5 -4/-4 -3/-3\n";

TEST_F(ObjCut, EveryTriangleHasTheCoordinatesOfItsCorners) {
  const auto found = cuts("map_d rgba.png\n", kConcave);
  ASSERT_EQ(found.size(), 5U);
  expect_in_place(found);
  EXPECT_EQ(found[0].cut.threshold, 127.5);
  EXPECT_EQ(found[0].cut.wrap_u, Wrap::kRepeat);
  EXPECT_EQ(whole_, 0U);
}

TEST_F(ObjCut, AndSoIfVerticesAreSpilled) {
  std::string faces;
  for (int i = 0; i < 20000; ++i) faces += "v 9 9 9\n";
  faces += "f 1/1 2/2 3/3 4/4 5/5\nf 1 2 3\nf 1/1 2/2 3/3\nusemtl n\nf 1/1 2/2 3/3\n";
  const auto expected = cuts("map_d rgba.png\n", faces);
  ASSERT_EQ(expected.size(), 4U);
  EXPECT_EQ(whole_, 2U);
  TestSpill spill(1 << 17);
  const auto found = cuts("map_d rgba.png\n", faces, spill.space());
  EXPECT_NE(spill.file(), nullptr);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(whole_, 2U);
  expect_in_place(found);
}

TEST_F(ObjCut, TheAlphaIsThatOfTheImageOrItsLuminance) {
  const auto alpha = [&](const std::string& statements) {
    return cuts(statements, kConcave).at(0).cut.image->texels();
  };
  using Texels = std::vector<uint8_t>;
  EXPECT_EQ(alpha("map_d rgba.png\n"), (Texels{255, 0, 0, 200}));
  EXPECT_EQ(alpha("map_d grey.png\n"), (Texels{10, 20, 30, 40}));
  EXPECT_EQ(alpha("d 0.5\nmap_d rgb.png\n"), Texels{(77 * 100 + 150 * 200 + 29 * 50) / 256});
}

TEST_F(ObjCut, OptionsOfTheTextureAreFollowedOrRefused) {
  const auto one = cuts("d 0.5\nmap_d -clamp on -s 2 4 1 -o 0.5 0.25 rgba.png\n", kConcave).at(0);
  EXPECT_EQ(one.cut.threshold, 255);
  EXPECT_EQ(one.cut.wrap_u, Wrap::kClamp);
  EXPECT_EQ(one.cut.wrap_v, Wrap::kClamp);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(one.texture[i].u, (one.triangle.v[i].x * 2 + 0.5) * 2);
    EXPECT_EQ(one.texture[i].v, (1 - (one.triangle.v[i].y * 4 + 0.25)) * 2);
  }
  EXPECT_EQ(cuts("map_d -blendu on -imfchan m -bm 1 rgba.png\n", kConcave).size(), 5U);
  for (const std::string option : {"-mm 0 1", "-t 1", "-blendv off", "-imfchan r"})
    EXPECT_SVDAG_ERROR(cuts("map_d " + option + " rgba.png\n", kConcave), ExitCode::kBadInput,
                       "material \"m\" has the option " + option.substr(0, option.find(' ')));
}

TEST_F(ObjCut, WhatIsNotCutIsWhole) {
  for (const char* whole : {"d 1\n", "Kd 1 1 1\nmap_Kd rgba.png\n", "d 0.5\n"}) {
    EXPECT_TRUE(cuts(whole, kConcave).empty()) << whole;
    EXPECT_EQ(whole_, 5U);
    EXPECT_EQ(left_out_[size_t(Omission::kCutOuts)], whole[2] == '0');
  }
  EXPECT_TRUE(cuts("map_d rgba.png\n", "f 1 2 3 4\nf 1//1 2//1 3//1\n").empty());
  EXPECT_EQ(whole_, 3U) << "without texture coordinates";
  EXPECT_EQ(left_out_[size_t(Omission::kCutOuts)], 1U);
  names_.cut_out = {"m*"};
  EXPECT_EQ(cuts("map_Kd rgba.png\n", kConcave).size(), 5U);
}

TEST_F(ObjCut, MaterialFilesThatAreNotReadAreCounted) {
  folder_.write("late.mtl", "newmtl n\n");
  const std::string comment = "#" + std::string(70000, ' ') + '\n';
  cuts("d 1\n", comment + "mtllib late.mtl\nmtllib a.mtl\nmtllib none.mtl\n");
  EXPECT_EQ(left_out_[size_t(Omission::kMaterialFiles)], 1U);
  EXPECT_EQ(left_out_[size_t(Omission::kMissingMaterials)], 1U);
}

TEST_F(ObjCut, BrokenFilesAreErrors) {
  const std::string mask = "map_d rgba.png\n";
  EXPECT_SVDAG_ERROR(cuts("map_d none.png\n", kConcave), ExitCode::kBadInput,
                     "--no-cutouts bakes the material whole");
  EXPECT_SVDAG_ERROR(cuts("map_d ../x.png\n", kConcave), ExitCode::kBadInput, "x.png");
  EXPECT_SVDAG_ERROR(cuts(mask, "f 1/1 2/2 3/6\n"), ExitCode::kBadInput,
                     "has a face with texture coordinate 6, but 5 precede it");
  EXPECT_SVDAG_ERROR(cuts(mask, "f 1/1 2 3/3\n"), ExitCode::kBadInput, "at some of its corners");
  EXPECT_SVDAG_ERROR(cuts(mask, "vt nan 0\nf 1/6 2/1 3/1\n"), ExitCode::kBadInput, "");
  EXPECT_SVDAG_ERROR(cuts(mask, "vt 1e30 0\nf 1/6 2/1 3/1\n"), ExitCode::kBadInput,
                     "beyond 2^40 texels");
}

}  // namespace
}  // namespace svdag
