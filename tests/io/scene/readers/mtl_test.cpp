#include "io/scene/readers/mtl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/io/scene/png_file.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

class Mtl : public testing::Test {
 protected:
  Mtl() : images_(&budget_, false, LinearImages::Detail::kThumbnails) {
    std::filesystem::create_directory(folder_.file("maps"));
    folder_.write("maps/red wood.png", one_texel(255, 0, 0));
    folder_.write("grey.png", one_texel(188, 188, 188));
    folder_.write("12.5", one_texel(1, 2, 3));
    folder_.write("a.obj", "mtllib a.mtl\n");
  }

  // Of material m.
  std::optional<Colour> colour(const std::string& statements) {
    folder_.write("a.mtl", "newmtl m\n" + statements);
    const auto materials = read_mtl(obj(), {&budget_, allow_outside_, &images_});
    const auto found = materials.by_name.find("m");
    return found == materials.by_name.end() ? std::nullopt : colour_of(found->second, &images_);
  }

  File obj() const { return File::open_read(folder_.file("a.obj")); }

  TempFolder folder_;
  MemoryBudget budget_;
  bool allow_outside_ = false;
  LinearImages images_;
};

TEST_F(Mtl, WithoutATextureTheColourIsKd) {
  EXPECT_EQ(colour("Kd 1 0.5 0\n"), (Colour{255, 128, 0}));
  EXPECT_EQ(colour("Ka 1 0.5 0\n"), std::nullopt);
  EXPECT_EQ(colour("map_Kd\nKd 1 0 1\nmap_Kd -s 1 1\n"), (Colour{255, 0, 255}));
}

TEST_F(Mtl, ATextureIsMultipliedByKdInLinearLight) {
  EXPECT_EQ(colour("map_Kd grey.png\n"), (Colour{188, 188, 188}));
  EXPECT_EQ(colour("map_Kd grey.png\nKd 1 0 0.7372549\n"), (Colour{188, 0, 138}));
  EXPECT_EQ(colour("Kd 1 0 0.7372549\nmap_Kd grey.png\n"), (Colour{188, 0, 138}));
  EXPECT_TRUE(images_.notes().empty());
}

TEST_F(Mtl, OptionsOfATextureAreSkipped) {
  for (const char* name :
       {"maps/red wood.png", "-s 2 2 1 maps/red wood.png", "-s 2 maps/red wood.png",
        "-o 0.5 -0.5 -t 1e-2 maps/red wood.png\r", "-clamp on -mm 0 1.5 \tmaps/red wood.png  ",
        "-blendu off -blendv off -cc on -boost 2 -texres 512 -bm 1 -imfchan l -type sphere "
        "maps/red wood.png",
        "maps\\red wood.png"})
    EXPECT_EQ(colour("map_Kd " + std::string(name) + "\n"), (Colour{255, 0, 0})) << name;
  EXPECT_EQ(colour("map_Kd -s 1 1 1 12.5\n"), (Colour{1, 2, 3})) << "at most three numbers";
  EXPECT_TRUE(images_.notes().empty());
}

TEST_F(Mtl, ATextureThatCannotBeReadLeavesKdAndOneNote) {
  folder_.write("bad.png", "not an image");
  EXPECT_EQ(colour("map_Kd bad.png\nKd 0 1 0\n"), (Colour{0, 255, 0}));
  EXPECT_EQ(colour("map_Kd bad.png\n"), std::nullopt);
  EXPECT_EQ(colour("map_Kd missing.png\n"), std::nullopt);
  EXPECT_EQ(colour("map_Kd maps\n"), std::nullopt);
  ASSERT_EQ(images_.notes().size(), 3u);
  EXPECT_EQ(images_.notes()[0],
            folder_.file("bad.png") + ": is not a readable PNG or JPEG image: unknown image type");
  EXPECT_EQ(images_.notes()[1],
            folder_.file("missing.png") + ": cannot be opened: no such file or folder");
}

TEST_F(Mtl, FilesAreThoseThatExist) {
  colour(
      "map_Kd maps/red wood.png\nmap_Kd missing.png\nnewmtl n\nmap_Kd grey.png\n"
      "newmtl o\nmap_Kd grey.png\n");
  EXPECT_EQ(mtl_files(obj(), {&budget_}),
            (std::vector<std::string>{folder_.file("a.mtl"), folder_.file("grey.png")}));
}

// A scene is not trusted: it may not make the program read any file of the user.
TEST_F(Mtl, FilesOutsideTheFolderAreReadOnlyOnRequest) {
  TempFolder elsewhere;
  elsewhere.write("red.png", one_texel(255, 0, 0));
  elsewhere.write("b.mtl", "newmtl m\nKd 0 0 1\n");
  std::filesystem::create_symlink(elsewhere.file("red.png"), folder_.file("link.png"));
  const std::string up = "../" + std::filesystem::path(elsewhere.path()).filename().string();
  folder_.write("a.obj", "mtllib a.mtl\nmtllib " + up + "/b.mtl\n");
  for (const std::string& name :
       {elsewhere.file("red.png"), up + "/red.png", std::string("link.png")}) {
    allow_outside_ = false;
    EXPECT_EQ(colour("map_Kd " + name + "\nKd 0 1 0\n"), (Colour{0, 255, 0})) << name;
    EXPECT_THAT(images_.notes().back(), testing::HasSubstr("outside the folder of the scene"));
    EXPECT_EQ(mtl_files(obj(), {&budget_}), std::vector{folder_.file("a.mtl")});
    allow_outside_ = true;
    EXPECT_EQ(colour("Kd 0 1 0\nmap_Kd " + name + "\n"), (Colour{0, 0, 0}))
        << "times 0 0 1 of b.mtl";
    EXPECT_EQ(mtl_files(obj(), {&budget_, true}).size(), 3u);
  }
}

TEST_F(Mtl, IsReadOnceWithinItsMemory) {
  std::string lines = "newmtl m\nKd 0 1 0\n";
  for (int i = 0; i < 3000; ++i) lines += "newmtl " + std::to_string(i) + "\n";
  folder_.write("a.obj", "mtllib a.mtl\nmtllib a.mtl\n");
  EXPECT_EQ(colour(lines), (Colour{0, 255, 0}));
  EXPECT_EQ(budget_.used(), 0U);
  EXPECT_LT(budget_.peak(), 3002U * 200);
  MemoryBudget little(100'000);
  EXPECT_SVDAG_ERROR(read_mtl(obj(), {&little}), ExitCode::kMemory, "materials of .mtl files");
  EXPECT_EQ(colour(std::string(100'000, 'x') + "\nKd 1 0 1\n#" + std::string(100'000, ' ')),
            (Colour{255, 0, 255}))
      << "lines of any length";
}

}  // namespace
}  // namespace svdag
