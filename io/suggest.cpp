#include "io/suggest.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace svdag {
namespace {

// The commands of each program. `trace` is not listed for svdag-verify, where it needs a scene: the
// word suggests svdag-trace.
constexpr std::pair<const char*, const char*> kPrograms[] = {
    {"svdag",
     "build batch plan run submit merge info query edit convert pack unpack export import"},
    {"svdag-verify", "check mesh diff vdb render report view"},
    {"svdag-trace", ""},
    {"svdag-scene", ""},
};

}  // namespace

std::string command_of_other_program(const std::string& word) {
  for (const auto& [program, commands] : kPrograms) {
    if (word == program || "svdag-" + word == program) return program;
    const bool known = (" " + std::string(commands) + " ").find(" " + word + " ") != word.npos;
    if (known && !word.empty() && word.find(' ') == word.npos) return program + (" " + word);
  }
  return "";
}

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] =
          std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  std::string best;
  size_t best_distance = word.size() / 3 + 1;
  for (const std::string& candidate : candidates) {
    // The difference in length is a lower bound of the distance.
    const size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) >= best_distance) continue;
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  if (!best.empty()) return best;
  const auto begins = [&](const std::string& candidate) { return candidate.starts_with(word); };
  const auto longer = std::ranges::find_if(candidates, begins);
  return word.empty() || longer == candidates.end() ? "" : *longer;
}

}  // namespace svdag
