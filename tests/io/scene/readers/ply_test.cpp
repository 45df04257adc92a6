#include <cmath>
#include <limits>

#include "io/scene/scene.h"
#include "tests/io/scene/read_text.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr const char* kSquareHeader =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
constexpr const char* kSquareVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const std::vector<Corners> kSquare = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
                                      {{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};

std::string square(const std::string& faces) {
  return std::string(kSquareHeader) + kSquareVertices + faces;
}

TEST(Ply, ReadsTextPolygons) {
  EXPECT_EQ(read(read_ply, square("4 0 1 2 3\n")).triangles, kSquare);
}

TEST(Ply, ReadsEveryLineEnding) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : square("4 0 1 2 3\n")) text += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read(read_ply, text).triangles, kSquare);
  }
}

TEST(Ply, TextDeclaredFloatIsRoundedToFloatAndDoubleIsTheNearestDouble) {
  for (const std::string type : {"float", "float32", "double", "float64", "int"}) {
    const auto reading =
        read(read_ply, "ply\nformat ascii 1.0\nelement vertex 3\nproperty " + type +
                           " x\nproperty double y\nproperty double z\nelement face 1\n"
                           "property list uchar int vertex_index\nend_header\n"
                           "0.1 0.1 +1e-3\n16777217 5 6\n7 8 9\n3 0 1 2\n");
    const bool single = type.starts_with("float") && type != "float64";
    const auto& t = reading.triangles.at(0);
    EXPECT_EQ(t[0][0], single ? double(0.1F) : 0.1);
    EXPECT_EQ(t[1][0], single ? 16777216 : 16777217);
    EXPECT_EQ(t[0][1], 0.1);
    EXPECT_EQ(t[0][2], 1e-3);
  }
}

TEST(Ply, NanAndInfinityAreHandedOn) {
  const auto t =
      read(read_ply, std::string(kSquareHeader) + "nan -inf 1e999\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n")
          .triangles.at(0);
  EXPECT_TRUE(std::isnan(t[0][0]));
  EXPECT_EQ(t[0][1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(t[0][2], std::numeric_limits<double>::infinity());
}

// The same mesh with awkward types, order and extra elements, in both byte orders.
std::string odd_binary(bool big) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\ncomment made by hand\nobj_info nothing\n"
                      "element face 2\nproperty uchar red\nproperty list ushort short "
                      "vertex_index\nproperty list uchar float weights\n"
                      "element material 2\nproperty list int double values\n"
                      "element vertex 4\nproperty double z\nproperty uchar q\nproperty short x\n"
                      "property list uchar int tags\nproperty float y\n"
                      "element empty 5\nend_header\n";
  for (const bool second : {false, true}) {
    bytes += raw(uint8_t(200)) + raw(uint16_t(3), big) + raw(int16_t(0), big);
    bytes += raw(int16_t(second ? 2 : 1), big) + raw(int16_t(second ? 3 : 2), big);
    bytes += raw(uint8_t(2)) + raw(1.0F, big) + raw(2.0F, big);
  }
  for (const int n : {0, 3}) {
    bytes += raw(int32_t(n), big);
    for (int i = 0; i < n; ++i) bytes += raw(0.5, big);
  }
  const int xy[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& p : xy) {
    bytes += raw(0.0, big) + raw(uint8_t(9)) + raw(int16_t(p[0]), big);
    bytes += raw(uint8_t(1)) + raw(int32_t(7), big) + raw(float(p[1]), big);
  }
  return bytes;
}

TEST(Ply, ReadsAnyPropertyOrderTypeAndElementOrderInBothByteOrders) {
  EXPECT_EQ(read(read_ply, odd_binary(false)).triangles, kSquare);
  EXPECT_EQ(read(read_ply, odd_binary(true)).triangles, kSquare);
}

// Plain float vertices and plain triangles: the fast path, with a polygon in between and bytes
// around the list.
std::string plain_binary(bool big, uint32_t third = 2) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\nelement face 3\nproperty uchar flag\n"
                      "property list uchar uint vertex_indices\nproperty short end\nend_header\n";
  const float xy[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& p : xy) bytes += raw(p[0], big) + raw(p[1], big) + raw(0.0F, big);
  const std::vector<std::vector<uint32_t>> faces = {{0, 1, third}, {0, 1, 2, 3}, {0, 2, 3}};
  for (const auto& face : faces) {
    bytes += raw(uint8_t(1)) + raw(uint8_t(face.size()));
    for (const uint32_t i : face) bytes += raw(i, big);
    bytes += raw(int16_t(-1), big);
  }
  return bytes;
}

TEST(Ply, PlainRowsGiveTheSameAsAnyOthers) {
  const std::vector<Corners> expected = {kSquare[0], kSquare[0], kSquare[1], kSquare[1]};
  EXPECT_EQ(read(read_ply, plain_binary(false)).triangles, expected);
  EXPECT_EQ(read(read_ply, plain_binary(true)).triangles, expected);
}

TEST(Ply, ReadsTriangleStripsWithRestartsAndWithoutStitches) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const auto reading = read(read_ply, header + kSquareVertices + "9 0 1 3 2 -1 3 2 2 0\n");
  // The second triangle of a strip is turned over to face the same side.
  const std::vector<Corners> expected = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                         {{{0, 1, 0}, {1, 0, 0}, {1, 1, 0}}}};
  EXPECT_EQ(reading.triangles, expected);
}

TEST(Ply, FacesOfLessThanThreeCornersAreIgnored) {
  EXPECT_TRUE(read(read_ply, square("2 0 1\n")).triangles.empty());
}

TEST(Ply, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(read(read_ply, "\xEF\xBB\xBF" + square("4 0 1 2 3\n")).triangles, kSquare);
}

TEST(Ply, ZerosInTextAreNoComment) {
  const std::string row("\0 0 1 2\n", 8);
  EXPECT_NE(refusal(read_ply, square(row + "4 0 1 2 3\n")), "");
  std::string comment = square("4 0 1 2 3\n");
  comment.insert(comment.find("element"), std::string("comment a\0b\n", 12));
  EXPECT_NE(refusal(read_ply, comment), "");
}

TEST(Ply, EveryTruncationIsRefused) {
  // The digits of the last index: "3" cut off ends too early, the line's end may go.
  expect_no_truncation_goes_unnoticed(read_ply, square("4 0 1 2 3\n"), 1);
  expect_no_truncation_goes_unnoticed(read_ply, odd_binary(false), 0);
  expect_no_truncation_goes_unnoticed(read_ply, plain_binary(false), 0);
}

TEST(Ply, IndicesThatPointNowhereAreRefused) {
  EXPECT_NE(refusal(read_ply, square("3 0 1 4\n")).find("vertex 4, but there are 4"),
            std::string::npos);
  EXPECT_NE(refusal(read_ply, square("3 0 -1 2\n")).find("vertex -1"), std::string::npos);
  EXPECT_NE(refusal(read_ply, plain_binary(false, 4)).find("at byte"), std::string::npos);
  EXPECT_NE(refusal(read_ply, plain_binary(false, UINT32_MAX)).find("4294967295"),
            std::string::npos);
}

TEST(Ply, CountsThatTheFileCannotHoldAreRefusedBeforeAnyMemoryIsTaken) {
  for (const char* count : {"5000", "2147483648", "9223372036854775807", "18446744073709551615"}) {
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
      for (const char* element : {"vertex", "other"}) {
        const std::string header =
            std::string("ply\nformat ") + format + " 1.0\nelement " + element + " " + count +
            "\nproperty float x\nproperty float y\nproperty float z\nelement " +
            (element[0] == 'v' ? "face" : "vertex") +
            " 1\nproperty list uchar int vertex_indices\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n0 0 0\n";
        EXPECT_NE(refusal(read_ply, header).find("more than its bytes can hold"),
                  std::string::npos);
      }
    }
  }
}

TEST(Ply, ListsThatTheFileCannotHoldAreRefused) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list int int vertex_indices\nend_header\n";
  for (const int32_t n : {-1, 1, INT32_MAX})
    EXPECT_NE(refusal(read_ply, header + raw(n)).find("list of"), std::string::npos);
}

TEST(Ply, BrokenHeadersAreRefused) {
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  for (const std::string& header : std::vector<std::string>{
           "", "plx\n", "ply\nend_header\n", "ply\nformat ascii 2.0\nend_header\n",
           "ply\nformat binary 1.0\nend_header\n", "ply\nformat ascii 1.0\nelement vertex 1\n",
           "ply\nformat ascii 1.0\nelement vertex -1\nend_header\n",
           "ply\nformat ascii 1.0\nproperty float x\nend_header\n",
           "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n",
           "ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\nend_header\n",
           "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
           "ply\nformat ascii 1.0\nelement vertex 1\n" + vertex + "element vertex 1\nend_header\n",
           "ply\nformat ascii 1.0\nelement vertex 1\n" + vertex +
               "element face 1\nproperty list int float vertex_indices\nend_header\n0 0 0\n0\n",
           "ply\nformat ascii 1.0\ngarbage\nend_header\n",
           "ply\nformat ascii 1.0\nelement face 0\nend_header\n"}) {
    EXPECT_NE(refusal(read_ply, header), "") << header;
  }
}

TEST(Ply, GarbageInsteadOfANumberIsRefusedWithItsLine) {
  const std::string text = std::string(kSquareHeader) + "0 0 0\n1 x1 0\n1 1 0\n0 1 0\n3 0 1 2\n";
  EXPECT_NE(refusal(read_ply, text).find("has \"x1\" where a number should be (line 11)"),
            std::string::npos);
}

TEST(Ply, HoldsFloatsAsFloatsInTheBudget) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 100000\nproperty TYPE x\nproperty TYPE y\n"
      "property TYPE z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  std::string body;
  for (int i = 0; i < 100000; ++i) body += "1 2 3\n";
  const auto peak_of = [&](const std::string& type) {
    std::string header = text;
    for (size_t at; (at = header.find("TYPE")) != std::string::npos;) header.replace(at, 4, type);
    return read(read_ply, header + body + "3 0 1 2\n").peak;
  };
  EXPECT_GE(peak_of("float"), 100000U * 12);
  EXPECT_GE(peak_of("double"), 100000U * 24);
  EXPECT_LE(peak_of("float"), 140000U * 12);
  EXPECT_LE(peak_of("double"), 140000U * 24);
}

TEST(Ply, ABudgetThatIsTooSmallIsAMemoryError) {
  const NameFilter names;
  try {
    read(read_ply, square("4 0 1 2 3\n"), names, 1000);
    FAIL() << "was read in 1000 bytes";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kMemory);
  }
}

// Colours of vertices, in sRGB, of a square and of a triangle; `type` and values of 1 and 0.5.
CornerColours colours_of(const std::string& type, const std::string& one, const std::string& half,
                         const std::string& prefix, size_t triangle) {
  const TempFolder folder;
  std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n";
  for (const char* const name : {"red", "green", "blue"})
    text += "property " + type + " " + prefix + name + "\n";
  text += "property uchar alpha\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  text += one + " 0 0 7 0 0 0\n" + "0 " + half + " 0 7 1 0 0\n" + "0 0 " + one + " 7 1 1 0\n" +
          "0 0 0 7 0 1 0\n4 0 1 2 3\n3 1 2 3\n";
  SceneConfig config;
  config.paths = {folder.write("s.ply", text)};
  config.colours = config.paint = true;
  MemoryBudget budget;
  std::vector<CornerColours> colours;
  Scene(config, &budget).stream([&](const TriangleBatch& batch) {
    EXPECT_NE(batch.paint, nullptr);
    colours.insert(colours.end(), batch.corner_colours.begin(), batch.corner_colours.end());
  });
  EXPECT_EQ(colours.size(), 3u);
  return colours.at(triangle);
}

TEST(Ply, ColoursOfVerticesAreReadIfWanted) {
  const VertexColour red = {kWhite16, 0, 0}, blue = {0, 0, kWhite16}, black = {0, 0, 0};
  const VertexColour green = {0, light16_of_code(128), 0};
  EXPECT_EQ(colours_of("uchar", "255", "128", "", 0), (CornerColours{red, green, blue}));
  EXPECT_EQ(colours_of("uchar", "255", "128", "", 1), (CornerColours{red, blue, black}));
  EXPECT_EQ(colours_of("uchar", "255", "128", "diffuse_", 2), (CornerColours{green, blue, black}));
  EXPECT_EQ(colours_of("ushort", "65535", "32896", "", 0), (CornerColours{red, green, blue}));
  EXPECT_EQ(colours_of("double", "1", "0.50196078431372548", "", 0),
            (CornerColours{red, green, blue}));
}

}  // namespace
}  // namespace svdag
