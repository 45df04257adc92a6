#include "io/scene/readers/obj_paint.h"

#include <gtest/gtest.h>

#include "tests/io/scene/mesh/test_spill.h"
#include "tests/io/scene/png_file.h"

namespace svdag {
namespace {

struct Painted {
  std::string material;
  Triangle triangle;
  TextureCorners texture;
  Paint paint;
  CornerColours colours;
};

TEST(ObjPaint, VerticesOnDiskMakeNoDifference) {
  const TempFolder folder;
  folder.write("a.png", one_texel(1, 2, 3));
  folder.write("b.png", one_texel(4, 5, 6));
  folder.write("a.mtl",
               "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd -clamp on b.png\nnewmtl c\nKd 1 0 0\n");
  std::string text = "mtllib a.mtl\nvt 0 0\nvt 4 0\nvt 4 4\nvt 1 1\nvt 0 4\n";
  for (const char* corner : {"0 0", "4 0", "4 4", "1 1", "0 4"})
    text += "v " + std::string(corner) + " 0\n";
  for (int i = 0; i < 20000; ++i) text += "v 9 9 9\n";
  text +=
      "usemtl a\nf 1/1 2/2 3/3 4/4 5/5\nf 1 2 3\nf 1/1 2/2 3/3\nusemtl b\nf 1/1/1 2/2/1 3/3/1\n"
      "usemtl c\nf 1/1 2/2 3/3\nf 1 2 4\nusemtl a\nf 2/2 3/3 4/4\n";
  const File file = File::open_read(folder.write("a.obj", text));
  const auto painted = [&](const SpillSpace* spill) {
    MemoryBudget budget;
    LinearImages images(&budget, false, LinearImages::Detail::kWhole);
    NameFilter names;
    ReadOptions options{&names, false, &budget, spill};
    options.images = &images;
    options.paints = &images;
    std::vector<Painted> found;
    read_meshes(read_obj, file, options, [&](const TriangleBatch& batch) {
      for (size_t i = 0; i < batch.triangles.size(); ++i) {
        Painted& each = found.emplace_back(
            Painted{std::string(batch.material), batch.triangles[i], {}, {}, {}});
        if (batch.paint == nullptr) continue;
        each.paint = *batch.paint;
        each.paint.image.reset();  // of this pass
        each.paint.factor[0] = batch.paint->image->levels()[0].at(0, 0)[0];
        each.texture = batch.texture[i];
        each.colours = batch.corner_colours[i];
      }
    });
    return found;
  };
  const auto expected = painted(nullptr);
  ASSERT_EQ(expected.size(), 9U);
  EXPECT_EQ(expected[0].paint.factor[0], light16_of_code(1));
  EXPECT_EQ(expected[3].paint.factor[0], 1) << "has no coordinates";
  EXPECT_EQ(expected[5].paint.wrap_u, Wrap::kClamp);
  TestSpill spill(1 << 17);
  const auto found = painted(spill.space());
  EXPECT_NE(spill.file(), nullptr);
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].material, expected[i].material);
    EXPECT_EQ(found[i].triangle.v, expected[i].triangle.v);
    EXPECT_EQ(found[i].texture, expected[i].texture);
    EXPECT_EQ(found[i].paint, expected[i].paint);
    EXPECT_EQ(found[i].colours, expected[i].colours);
  }
}

}  // namespace
}  // namespace svdag
