#include "io/scene/scene.h"
#include "streaming/file/byte_stream.h"
#include "tests/io/scene/read_text.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr const char* kVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<Corners> faces(const std::string& statements) {
  return read(read_obj, kVertices + statements).triangles;
}

TEST(Obj, ReadsEveryFormOfCorner) {
  for (const char* face :
       {"f 1 2 3", "f 1/7 2/7 3/7", "f 1//5 2//5 3//5", "f 1/1/1 2/2/2 3/3/3", "f -4 -3 -2",
        "f -4/-1/-1 -3/-1/-1 -2/-1/-1", "f 1/ 2/ 3/", "  f\t+1  2 3  # all of it"}) {
    EXPECT_EQ(faces(face), std::vector<Corners>{kLower}) << face;
  }
}

TEST(Obj, ReadsPolygons) {
  EXPECT_EQ(faces("f 1 2 3 4\n"), (std::vector<Corners>{kLower, kUpper}));
  EXPECT_TRUE(faces("f 1 2\nf\nf 1\n").empty());
}

TEST(Obj, SkipsAByteOrderMark) {
  EXPECT_EQ(read(read_obj, "\xEF\xBB\xBF" + std::string(kVertices) + "f 1 2 3").triangles,
            std::vector<Corners>{kLower});
}

TEST(Obj, NegativeIndicesCountBackFromTheFace) {
  EXPECT_EQ(faces("v 5 5 5\nf 1 2 -1\nv 6 6 6\nf 1 2 -1\n"),
            (std::vector<Corners>{{{{0, 0, 0}, {1, 0, 0}, {5, 5, 5}}},
                                  {{{0, 0, 0}, {1, 0, 0}, {6, 6, 6}}}}));
}

TEST(Obj, ReadsWeightsColoursContinuationsAndAnyLineEnding) {
  const std::string text =
      "# a comment \\\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 1 \\\n 1 0\n\nf 1 \\\n2 3\\\n\n"
      "vt 0 0\nvn 0 0 1\nusemtl stone\ns off\nmtllib a b.mtl\nl 1 2\np 1\n";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string ended;
    for (const char c : text) ended += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read(read_obj, ended).triangles, std::vector<Corners>{kLower});
  }
}

TEST(Obj, TextIsReadToTheNearestDouble) {
  const auto t = read(read_obj, "v 0.1 1e-320 1.7976931348623157e308\nv 1 1 1\nv 2 2 2\nf 1 2 3")
                     .triangles.at(0);
  EXPECT_EQ(t[0], (std::array<double, 3>{0.1, 1e-320, 1.7976931348623157e308}));
}

TEST(Obj, FacesAreChosenByGroupAndObject) {
  const std::string text = std::string(kVertices) +
                           "f 1 2 3\ng roof tiles\nf 1 2 3\no house\nf 1 3 4\ng wall\nf 1 3 4\n";
  const auto meshes = [&](const NameFilter& names) { return read(read_obj, text, names).meshes; };
  using Names = std::vector<std::string>;
  EXPECT_EQ(meshes({}), (Names{"", "roof", "roof", "wall"}));
  EXPECT_EQ(meshes({{"tiles"}, {}}), (Names{"roof", "roof"}));
  EXPECT_EQ(meshes({{"house"}, {}}), (Names{"roof", "wall"}));
  EXPECT_EQ(meshes({{"ho*"}, {"tiles"}}), Names{"wall"});
  EXPECT_EQ(meshes({{}, {"house"}}), (Names{"", "roof"}));
  EXPECT_EQ(meshes({{"nothing"}, {}}), Names{});
}

TEST(Obj, TrianglesAreNumberedWithinTheirGroup) {
  const MemoryFile memory(std::string(kVertices) + "g a\nf 1 2 3 4\ng b\nf 1 2 3\n");
  MemoryBudget budget;
  const NameFilter names;
  std::vector<uint64_t> firsts;
  read_meshes(read_obj, memory.file(), {&names, false, &budget},
              [&](const TriangleBatch& batch) { firsts.push_back(batch.first); });
  EXPECT_EQ(firsts, (std::vector<uint64_t>{0, 0}));
}

TEST(Obj, IndicesThatPointNowhereAreRefusedWithTheirLine) {
  for (const char* index :
       {"0", "5", "-5", "999999999999999999", "-999999999999999999", "9223372036854775808"}) {
    const std::string text = std::string(kVertices) + "f 1 2 " + index + "\nv 9 9 9\n";
    EXPECT_NE(refusal(read_obj, text).find("(line 5)"), std::string::npos) << index;
  }
}

TEST(Obj, GarbageIsRefused) {
  for (const char* line :
       {"v 1 2", "v 1 2 x", "v 1 2 3x", "v 1 2 +-3", "f 1 2 x", "f 1 2 3x", "f 1/a 2 3",
        "f 1 2 9999999999999999999999", "f 1.5 2 3", "f 1 2 /3", "fx 1 2 3", "\x01"}) {
    EXPECT_NE(refusal(read_obj, std::string(kVertices) + line + "\n").find("(line 5)"),
              std::string::npos)
        << line;
  }
}

// A hole that a crash left begins and ends anywhere; what it covers would go without a word.
TEST(Obj, ZerosAreRefusedInWhatIsSkippedToo) {
  for (const size_t size : {1, 40, 4096, 5000}) {
    const std::string hole(size, '\0');
    for (const char* line :
         {"", "v 1 2 3 ", "vn 0 ", "vt ", "# a", "usemtl a", "g a", "o a", "s 1", "f 1 2 3 "}) {
      const std::string start = std::string(kVertices) + line + hole;
      EXPECT_NE(refusal(read_obj, start + "f 1 2 3\nf 1 2 4\n"), "") << line << size;
      EXPECT_NE(refusal(read_obj, start + " b\nf 1 2 4\n"), "") << line << size;
      // A few may follow the last line: some programs end a file so.
      if (*line == '\0' && size <= 16) continue;
      EXPECT_NE(refusal(read_obj, start), "") << line << size;
    }
  }
}

TEST(Obj, WordsThatAreTooLongAreRefusedWhereverTheWindowEnds) {
  for (const size_t digits : {5000U, 300000U}) {
    const std::string word(digits, '1');
    refusal(read_obj, std::string(kVertices) + "f 1 2 " + word);
    refusal(read_obj, std::string(kVertices) + "f 1 2 3/" + word + "x");
    refusal(read_obj, std::string(kVertices) + "g " + word);
    EXPECT_EQ(faces("# " + word + "\nf 1 2 3").size(), 1U) << "comments may be of any length";
  }
}

// A window ends somewhere in every kind of token.
TEST(Obj, TokensMayStraddleTheWindow) {
  std::string text = kVertices;
  std::vector<Corners> expected;
  while (text.size() < 3 * ByteStream::kWindow) {
    text += "f 1/22/333 \\\n 2/4444/55555   3/1/1 # and so on\n";
    expected.push_back(kLower);
  }
  for (size_t shift = 0; shift < 60; shift += 7)
    ASSERT_EQ(read(read_obj, std::string(shift, '\n') + text).triangles, expected);
}

// After a weight, if there is one; where none follow, white.
TEST(Obj, ColoursOfVerticesAreReadIfWanted) {
  const TempFolder folder;
  SceneConfig config;
  config.paths = {folder.write("s.obj",
                               "v 0 0 0 1 0 0\nv 1 0 0 1 0 0.5 2\nv 1 1 0\nv 0 1 0 0 0 0\n"
                               "f 1 2 3 4\nf 4 2 1\n")};
  config.colours = config.paint = true;
  MemoryBudget budget;
  std::vector<CornerColours> colours;
  Scene(config, &budget).stream([&](const TriangleBatch& batch) {
    colours.insert(colours.end(), batch.corner_colours.begin(), batch.corner_colours.end());
  });
  const VertexColour red = {kWhite16, 0, 0}, white = {kWhite16, kWhite16, kWhite16}, black = {};
  const VertexColour other = {0, light16_of_srgb(0.5), kWhite16};
  EXPECT_EQ(colours, (std::vector<CornerColours>{
                         {red, other, white}, {red, white, black}, {black, other, red}}));
}

}  // namespace
}  // namespace svdag
