#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

const Corners kFirst = {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, -2}}};
const Corners kSecond = {{{3, 3, 3}, {3, 3, 3}, {4, 4, 4}}};

std::string binary(const std::vector<Corners>& triangles, const std::string& title = "a part") {
  std::string bytes = title + std::string(80 - title.size(), ' ') + raw(uint32_t(triangles.size()));
  for (const Corners& t : triangles) {
    for (int i = 0; i < 3; ++i) bytes += raw(-1.0F);
    for (const auto& p : t) {
      for (const double x : p) bytes += raw(float(x));
    }
    bytes += raw(uint16_t(0xffff));
  }
  return bytes;
}

constexpr const char* kFacet =
    "facet normal nan 0 0\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 .5 -2e0\n"
    " endloop\nendfacet\n";
constexpr const char* kOther =
    "FACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 3 3 3\r\nVERTEX +3 3 3\r\nVERTEX 4 4 4\r\n"
    "ENDLOOP\r\nENDFACET\r\n";

TEST(Stl, ReadsBinary) {
  EXPECT_EQ(read(read_stl, binary({kFirst, kSecond})).triangles,
            (std::vector<Corners>{kFirst, kSecond}));
}

TEST(Stl, BinaryThatBeginsWithSolidIsStillBinary) {
  EXPECT_EQ(read(read_stl, binary({kFirst}, "solid facet")).triangles.size(), 1U);
}

TEST(Stl, ReadsMoreTrianglesThanABatchOrAWindow) {
  const std::vector<Corners> many(10000, kFirst);
  EXPECT_EQ(read(read_stl, binary(many)).triangles, many);
}

TEST(Stl, ReadsSeveralSolidsWithNames) {
  const auto reading = read(read_stl, std::string("solid  left wing \n") + kFacet +
                                          "endsolid left wing\n\nsolid\n" + kOther + "endsolid");
  EXPECT_EQ(reading.triangles, (std::vector<Corners>{kFirst, kSecond}));
  EXPECT_EQ(reading.meshes, (std::vector<std::string>{"left wing", ""}));
}

TEST(Stl, SolidsAreChosenByName) {
  const std::string text =
      std::string("solid a\n") + kFacet + "endsolid a\nsolid b\n" + kOther + "endsolid b\n";
  EXPECT_EQ(read(read_stl, text, {{"b"}, {}}).triangles, std::vector<Corners>{kSecond});
  EXPECT_EQ(read(read_stl, text, {{}, {"b"}}).triangles, std::vector<Corners>{kFirst});
}

TEST(Stl, TextIsReadToTheNearestDouble) {
  std::string facet = kFacet;
  facet.replace(facet.find(".5"), 2, "0.1");
  EXPECT_EQ(read(read_stl, "solid\n" + facet + "endsolid\n").triangles[0][2][1], 0.1);
}

TEST(Stl, EveryTruncationIsRefused) {
  expect_no_truncation_goes_unnoticed(read_stl, binary({kFirst, kSecond}), 0);
  // A text may lack its end, but not the end of a facet.
  const std::string text = std::string("solid\n") + kFacet;
  const std::string facet_end = "endfacet";
  const size_t last = text.rfind(facet_end) + facet_end.size();
  for (size_t size = 7; size < last; ++size)
    EXPECT_NE(refusal(read_stl, text.substr(0, size)), "") << "cut at " << size;
  EXPECT_EQ(read(read_stl, text).triangles.size(), 1U);
}

TEST(Stl, ACountThatDoesNotFitTheSizeIsRefused) {
  for (const std::string& bytes : {binary({kFirst}) + std::string(50, 'x'), binary({}) + "x"})
    EXPECT_NE(refusal(read_stl, bytes).find("promises"), std::string::npos);
  std::string many = binary({kFirst});
  many.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_NE(refusal(read_stl, many).find("4294967295"), std::string::npos);
}

TEST(Stl, LessThanATriangleMayStandBehindTheLast) {
  for (const char* title : {"a part", "solid part"}) {
    for (const std::string& more : {std::string("\n"), std::string(49, '\0')})
      EXPECT_EQ(read(read_stl, binary({kFirst}, title) + more).triangles.size(), 1U) << title;
  }
}

TEST(Stl, ABinaryFileThatIsCutOffIsNotTakenForText) {
  std::string bytes = binary({kFirst, kSecond}, "solid part");
  bytes.resize(bytes.size() - 20);
  EXPECT_NE(refusal(read_stl, bytes).find("promises 2 triangles"), std::string::npos);
}

TEST(Stl, TextMayBeginWithAByteOrderMark) {
  const std::string text = "\xEF\xBB\xBFsolid\n" + std::string(kFacet) + "endsolid\n";
  EXPECT_EQ(read(read_stl, text).triangles.size(), 1U);
}

// What a crash or a broken copy leaves of a block.
TEST(Stl, ZerosInTextAreNoComment) {
  const std::string filler(600, ' ');
  for (const char* hole : {"\n", "endsolid\n"}) {
    std::string text = "solid\n" + filler + kFacet + std::string(100, '\0') + hole + kFacet;
    if (*hole == '\n') text += "endsolid\n";
    EXPECT_NE(refusal(read_stl, text), "");
  }
  std::string normals = "solid\n" + filler + kFacet + kFacet + "endsolid\n";
  const size_t begin = normals.find("normal") + 7, end = normals.rfind("normal") + 8;
  normals.replace(begin, end - begin, end - begin, '\0');  // one facet's to the next one's
  EXPECT_NE(refusal(read_stl, normals), "");
}

TEST(Stl, BrokenTextIsRefusedWithItsLine) {
  std::string four = kFacet;
  four.insert(four.find(" endloop"), " vertex 9 9 9\n");
  EXPECT_NE(refusal(read_stl, "solid\n" + four + "endsolid\n").find("(line 7)"), std::string::npos);
  std::string word = kFacet;
  word.replace(word.find("1 0 0"), 5, "1 O 0");
  EXPECT_NE(refusal(read_stl, "solid\n" + word + "endsolid\n").find("has \"O\""),
            std::string::npos);
}

}  // namespace
}  // namespace svdag
