#include "io/values/decimal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace svdag {
namespace {

constexpr int kStrings = 4'000'000;

// What both functions say about the start of `text`; not on the last bytes, where there is no
// quick way, unless `bare`.
void expect_same(const std::string& text, bool bare = false) {
  const std::string padded = bare ? text : text + std::string(40, ' ');
  const char *first = padded.data(), *last = first + padded.size();
  double ours = 0.125, theirs = 0.125;  // an error must leave the value alone
  const auto [stop, error] = parse_decimal(first, last, ours);
  const auto expected = std::from_chars(first, last, theirs);
  ASSERT_EQ(stop, expected.ptr) << text;
  ASSERT_EQ(error, expected.ec) << text;
  ASSERT_EQ(std::bit_cast<uint64_t>(ours), std::bit_cast<uint64_t>(theirs)) << text;
}

using Random = std::mt19937_64;

std::string digits(Random& random, uint64_t most) {
  std::string text(random() % (most + 1), '0');
  const bool leading_zeros = random() % 4 == 0;
  for (size_t i = leading_zeros ? text.size() / 2 : 0; i < text.size(); ++i)
    text[i] = char('0' + random() % 10);
  return text;
}

TEST(Decimal, RandomNumbersAreThoseOfFromChars) {
  Random random(1);
  for (int i = 0; i < kStrings; ++i) {
    std::string text = random() % 2 ? "-" : "";
    text += digits(random, random() % 2 ? 4 : 10);
    if (random() % 8 != 0) text += '.';
    text += digits(random, random() % 2 ? 10 : 20);
    if (random() % 8 == 0) text += (random() % 2 ? "e-" : "E") + digits(random, 3);
    ASSERT_NO_FATAL_FAILURE(expect_same(text));
  }
}

TEST(Decimal, PrintedDoublesAndFloatsAreThoseOfFromChars) {
  Random random(2);
  std::uniform_real_distribution<double> magnitude(-12, 8);
  char text[64];
  for (int i = 0; i < kStrings / 4; ++i) {
    const double value = std::pow(10, magnitude(random)) * (random() % 2 ? 1 : -1);
    const int precision = int(random() % 20);
    std::snprintf(text, sizeof text, random() % 2 ? "%.*g" : "%.*f", precision, value);
    ASSERT_NO_FATAL_FAILURE(expect_same(text));
    std::snprintf(text, sizeof text, "%.9g", double(float(value)));
    ASSERT_NO_FATAL_FAILURE(expect_same(text));
  }
}

TEST(Decimal, RandomCharactersAreReadAsFarAsFromCharsReads) {
  Random random(3);
  constexpr std::string_view kCharacters = "00112345678999...--+eE xnaif/\n\t\x7f\x80\xff";
  for (int i = 0; i < kStrings; ++i) {
    std::string text(1 + random() % 24, '\0');
    for (char& c : text) c = kCharacters[random() % kCharacters.size()];
    ASSERT_NO_FATAL_FAILURE(expect_same(text, random() % 4 == 0));
  }
}

TEST(Decimal, MantissasAroundTheLargestExactOne) {
  for (uint64_t m = (uint64_t(1) << 53) - 1000; m < (uint64_t(1) << 53) + 1000; ++m) {
    const std::string number = std::to_string(m);
    for (size_t point = 0; point <= number.size(); ++point)
      ASSERT_NO_FATAL_FAILURE(expect_same(number.substr(0, point) + "." + number.substr(point)));
  }
}

TEST(Decimal, DigitsOfEveryCountAndWhateverFollows) {
  for (int follower = 0; follower < 256; ++follower) {
    if (follower >= '0' && follower <= '9') continue;
    uint64_t value = 0;
    for (int count = 0; count <= 8; ++count) {
      std::string text = std::string("98765432").substr(0, size_t(count));
      text.resize(8, char(follower));
      const Digits found = leading_digits(text.data());
      EXPECT_EQ(found.count, count);
      EXPECT_EQ(found.value, value) << follower;
      value = 10 * value + uint64_t(9 - count);
    }
  }
}

}  // namespace
}  // namespace svdag
