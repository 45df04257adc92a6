#include "tests/bench/sort_keys.h"

#include <random>

#include "streaming/error.h"

namespace svdag::bench {

std::vector<Key> make_keys(const std::string& kind, size_t count) {
  SVDAG_ASSERT(kind == "random" || kind == "nodes");
  constexpr uint32_t kRanks = 1 << 22, kNear = 1 << 12;
  std::mt19937_64 random(7);
  std::vector<Key> keys(count);
  uint32_t centre = 0;
  for (Key& key : keys) {
    if (kind == "random") {
      key = std::bit_cast<Key>(std::array<uint64_t, 4>{random(), random(), random(), random()});
      continue;
    }
    if (random() % 64 == 0) centre = uint32_t(random() % (kRanks - kNear));
    for (uint32_t& word : key) {
      const uint64_t bits = random();
      const bool there = bits % 100 < 55;
      word = there ? 1 + centre + uint32_t(bits >> 32) % kNear : 0;
    }
  }
  return keys;
}

}  // namespace svdag::bench
