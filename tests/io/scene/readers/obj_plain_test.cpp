// The quick way through plain lines against the way word by word, which a tab behind the statement
// enforces.
#include "io/scene/readers/obj_plain.h"

#include <random>

#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

using Random = std::mt19937_64;

template <size_t N>
std::string any_of(Random& random, const std::array<const char*, N>& choices) {
  return choices[random() % N];
}

std::string number(Random& random) {
  static constexpr std::array<const char*, 14> kNumbers = {
      "0",   "-0",   "1.5",  "-22.0427704",         "+3",
      "1e5", ".5",   "5.",   "0.10000000149011612", "12345678",
      "-7",  "1e-3", "1.25", "581311.125"};
  if (random() % 400 == 0) return any_of<4>(random, {"x", "+-3", "1.5x", "--1"});
  return any_of(random, kNumbers);
}

std::string corner(Random& random) {
  if (random() % 400 == 0)
    return any_of<6>(random, {"0", "99", "1.5", "/3", "1/a", "123456789012345678901"});
  return any_of<6>(random, {"1", "2", "3", "+4", "-1", "00000002"}) +
         any_of<9>(random, {"", "", "", "/1", "//5", "/6/77", "/", "/-1/-2", "/123456789"});
}

// About as many kinds of lines as there are; the triangles before an error count.
std::string random_scene(Random& random) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  for (int line = 0; line < 60; ++line) {
    const bool vertex = random() % 2 == 0;
    text += any_of<12>(random, {"", "", "", "", "", "", "", " ", "vt 1 2\n", "vn 0 # \\\n",
                                "vt \\\n 1\n", "# a comment \\\n"});
    text += vertex ? "v" : "f";
    const uint64_t words = vertex ? 3 + random() % 2 : random() % 3 != 0 ? 3 : random() % 11;
    for (uint64_t word = 0; word < words; ++word) {
      text += any_of<8>(random, {" ", " ", " ", " ", " ", "  ", "\t", " \\\n"});
      text += vertex ? number(random) : corner(random);
    }
    text += any_of<8>(random, {"\n", "\n", "\n", "\n", "\r\n", " \n", " # end\n", "\r"});
  }
  return text;
}

std::string word_by_word(std::string text) {
  for (size_t i = 0; i + 1 < text.size(); ++i) {
    const bool statement = (text[i] == 'v' || text[i] == 'f') && text[i + 1] == ' ';
    if (statement) text[i + 1] = '\t';
  }
  return text;
}

// The bits of all corners up to the end or the error, and what the error says.
std::pair<std::vector<uint64_t>, std::string> outcome(const std::string& text) {
  const MemoryFile memory(text);
  MemoryBudget budget;
  const NameFilter names;
  std::vector<uint64_t> bits;
  try {
    read_meshes(read_obj, memory.file(), {&names, false, &budget}, [&](const TriangleBatch& batch) {
      for (const Triangle& t : batch.triangles) {
        for (const Point& p : t.v) {
          for (int a = 0; a < 3; ++a) bits.push_back(std::bit_cast<uint64_t>(p[a]));
        }
      }
    });
  } catch (const Error& error) {
    return {bits, error.what()};
  }
  return {bits, ""};
}

TEST(ObjPlain, PlainLinesMeanWhatTheyMeanWordByWord) {
  Random random(4);
  int refused = 0, triangles = 0;
  const std::string tail = "#" + std::string(100, '-') + "\n";  // a window that ends behind them
  for (int scene = 0; scene < 20000; ++scene) {
    const std::string text = random_scene(random) + (scene % 8 == 0 ? "" : tail);
    const auto [bits, error] = outcome(text);
    const auto [expected_bits, expected_error] = outcome(word_by_word(text));
    ASSERT_EQ(bits, expected_bits) << text;
    ASSERT_EQ(error.substr(error.find(": ") + 1),
              expected_error.substr(expected_error.find(": ") + 1))
        << text;
    refused += !error.empty();
    triangles += int(bits.size() / 9);
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(triangles, 100000);
}

TEST(ObjPlain, AFaceOfManyCornersOrForeignFormIsLeftToTheScanner) {
  const auto is_plain = [](std::string text) {
    PlainFace face;
    text += "\n" + std::string(80, ' ');
    return read_plain_face(text, 4, &face) != nullptr;
  };
  EXPECT_TRUE(is_plain("1 2 3"));
  EXPECT_TRUE(is_plain("1/2/3 2//3 4/7  "));
  EXPECT_TRUE(is_plain("1 2 3 4 1 2 3 4"));
  for (const char* text : {"1 2 3 4 1 2 3 4 1", "0 1 2", "1 2 5", "1 2 -1", "1\t2 3", "1 2 3 # end",
                           "1 2 00000003", "1/-1 2 3", "1/2/3/4 2 3"})
    EXPECT_FALSE(is_plain(text)) << text;
}

}  // namespace
}  // namespace svdag
