#include "streaming/file/byte_stream.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

// All lines of `text` read through a window of `window` bytes.
std::vector<std::string> lines_of(const std::string& text, size_t window) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("text", text));
  ByteStream stream(file, 0, UINT64_MAX, window);
  std::vector<std::string> lines;
  while (const auto line = stream.line()) lines.emplace_back(*line);
  return lines;
}

// The lines by definition: "\n", "\r\n", "\r" and the end of the file end a line.
std::vector<std::string> expected_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\n' && text[i] != '\r') {
      line += text[i];
      if (i + 1 < text.size()) continue;
    } else if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
      ++i;
    }
    lines.push_back(line);
    line.clear();
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(ByteStream, AcceptsThreeKindsOfLineEnds) {
  EXPECT_EQ(lines_of("a\nb\r\nc\rd", 64), (Lines{"a", "b", "c", "d"}));
  EXPECT_EQ(lines_of("\n\r\n\r", 64), (Lines{"", "", ""}));
  EXPECT_EQ(lines_of("", 64), Lines{});
}

TEST(ByteStream, ACrlfAcrossTheEndOfTheWindowIsOneLineEnd) {
  for (size_t window = 1; window <= 8; ++window)
    EXPECT_EQ(lines_of("abc\r\ndef\r\n\r\nx", window), (Lines{"abc", "def", "", "x"})) << window;
}

RC_GTEST_PROP(ByteStream, LinesDoNotDependOnTheWindow, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::element('a', 'b', '\r', '\n'));
  const auto window = *any_of<size_t>(1, 12);
  RC_ASSERT(lines_of(text, window) == expected_lines(text));
}

RC_GTEST_PROP(ByteStream, PeekSkipAndReadShowTheBytesOfTheFile, ()) {
  const auto text = *rc::gen::container<std::string>(any_of<char>('a', 'z'));
  const auto window = *any_of<size_t>(1, 12);
  const TempFolder folder;
  const File file = File::open_read(folder.write("bytes", text));
  ByteStream stream(file, 0, UINT64_MAX, window);
  size_t at = 0;
  for (const uint8_t step : *rc::gen::arbitrary<std::vector<uint8_t>>()) {
    const auto seen = stream.peek(step % 20);
    RC_ASSERT(seen.size() >= std::min<size_t>(step % 20, text.size() - at));
    RC_ASSERT(std::equal(seen.begin(), seen.end(), std::as_bytes(std::span(text)).begin() + at));
    std::string copy(std::min<size_t>(step / 16, text.size() - at), '\0');
    if (step % 2 == 0) {
      stream.read(std::as_writable_bytes(std::span(copy)));
      RC_ASSERT(copy == text.substr(at, copy.size()));
    } else {
      stream.skip(copy.size());
    }
    at += copy.size();
    RC_ASSERT(stream.offset() == at);
    RC_ASSERT(stream.remaining() == text.size() - at);
  }
}

TEST(ByteStream, ReadsOnlyItsRangeOfTheFile) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "0123456789"));
  ByteStream stream(file, 2, 5);
  EXPECT_EQ(stream.offset(), 2U);
  EXPECT_EQ(stream.peek(100).size(), 3U);
  EXPECT_EQ(*stream.line(), "234");
  EXPECT_TRUE(stream.at_end());
  EXPECT_EQ(ByteStream(file, 20).remaining(), 0U);
}

TEST(ByteStream, AnEarlyEndIsBadInput) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "0123456789"));
  ByteStream stream(file);
  std::byte out[11];
  EXPECT_SVDAG_ERROR(stream.read(out), ExitCode::kBadInput, "ends too early (at byte 10)");
  EXPECT_SVDAG_ERROR(stream.skip(11), ExitCode::kBadInput, "ends too early");
}

TEST(ByteStream, ALineThatIsTooLongIsBadInput) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", std::string(100, 'x') + "\ny"));
  ByteStream stream(file, 0, UINT64_MAX, 16);
  EXPECT_SVDAG_ERROR(stream.line(50), ExitCode::kBadInput, "line that is too long");
}

TEST(ByteStream, EndsEarlierIfTheFileIsTruncatedMeanwhile) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "0123456789"));
  ByteStream stream(file, 0, UINT64_MAX, 4);
  stream.peek(4);
  std::filesystem::resize_file(folder.file("a"), 6);
  stream.skip(4);
  EXPECT_EQ(stream.peek(6).size(), 2U);
  EXPECT_EQ(stream.remaining(), 2U);
}

}  // namespace
}  // namespace svdag
