// Arbitrary bytes as one word of a command line: a letter selects the parser of the rest. The
// result is a value, which is the same after formatting and parsing it again, or an Error (usage).
#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "io/suggest.h"
#include "io/units.h"
#include "tests/fuzz/file_fuzz.h"

namespace svdag {
namespace {

constexpr size_t kLongest = 100;  // six numbers; to compare two words takes the product of theirs

void require(bool condition) {
  if (!condition) std::abort();
}

void try_count(const std::string& word) {
  const uint64_t count = parse_count(word, "--count");
  require(parse_count(std::to_string(count), "--count") == count);
  for (const char c : word) require(std::isalnum(static_cast<unsigned char>(c)) != 0);
}

void try_resolution(const std::string& word) {
  const int levels = parse_resolution(word);
  require(levels >= 3 && levels <= 20);
  require(parse_resolution(format_resolution(uint64_t(1) << levels)) == levels);
}

void try_bounds(const std::string& word) {
  const Box box = parse_bounds(word);
  std::string again;
  for (int i = 0; i < 6; ++i)
    again += (i == 0 ? "" : ",") + format_double(i < 3 ? box.min[i] : box.max[i - 3]);
  const Box same = parse_bounds(again);
  for (int a = 0; a < 3; ++a) {
    require(box.min[a] <= box.max[a]);
    require(same.min[a] == box.min[a] && same.max[a] == box.max[a]);
  }
}

void try_iso(const std::string& word) {
  const ValueRange range = parse_iso(word);
  require(range.low <= range.high);
  const ValueRange same = parse_iso(format_double(range.low) + "," + format_double(range.high));
  require(same.low == range.low && same.high == range.high);
}

// Two words separated by a space.
void try_nearest(const std::string& words) {
  const size_t space = std::min(words.find(' '), words.size());
  const std::string a = words.substr(0, space);
  const std::string b = words.substr(std::min(space + 1, words.size()));
  const size_t distance = edit_distance(a, b);
  const size_t longer = std::max(a.size(), b.size()), shorter = std::min(a.size(), b.size());
  require(distance == edit_distance(b, a) && (distance == 0) == (a == b));
  require(distance >= longer - shorter && distance <= longer);
  const std::vector<std::string> candidates = {b, "--output", "build"};
  const std::string found = nearest(a, candidates);
  require(found.empty() || 3 * edit_distance(a, found) <= std::max(a.size(), found.size()));
}

void try_word(char kind, const std::string& word) {
  switch (kind) {
    case 'c':
      return try_count(word);
    case 'r':
      return try_resolution(word);
    case 'b':
      return try_bounds(word);
    case 'i':
      return try_iso(word);
    default:
      return try_nearest(word);
  }
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  if (size == 0) return 0;
  const std::string word(reinterpret_cast<const char*>(data) + 1, std::min(size - 1, kLongest));
  expect_only_errors([&] { try_word(char(data[0]), word); }, ExitCode::kUsage);
  return 0;
}
