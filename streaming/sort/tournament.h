// A tree of losers (Knuth, TAOCP 3, 5.4.1) that finds the smallest head of many sorted sources.
//
// Every inner node stores the loser of its match, so replacing the winner costs one comparison per
// level on the path from its leaf to the root. A node also stores the first 64 bits of its loser's
// head, which decide most matches without reading the sources and without a branch.
// Rejected: a binary heap (two comparisons per level), a linear search (fine for three sources, not
// for three hundred).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace svdag {

// `prefix(a)` returns the first 64 bits of the head of source a; UINT64_MAX if it has ended.
// `less(a, b)` is called for equal prefixes and returns whether source a goes before source b; a
// source that has ended goes last.
template <class Prefix, class Less>
class Tournament {
 public:
  Tournament(size_t sources, Prefix prefix, Less less)
      : prefix_(prefix), less_(less), losers_(sources) {
    if (sources > 0) winner_ = sources > 1 ? play(1) : Player{prefix_(0), 0};
  }

  // The source with the smallest head. Requires at least one source.
  size_t winner() const { return winner_.source; }
  // Updates the tree after the winner's head has changed.
  void replay() {
    Player contender{prefix_(winner_.source), winner_.source};
    for (size_t node = (contender.source + losers_.size()) / 2; node > 0; node /= 2) {
      const Player other = losers_[node];
      const bool loses = before(other, contender);
      losers_[node] = loses ? contender : other;
      contender = loses ? other : contender;
    }
    winner_ = contender;
  }

 private:
  struct Player {
    uint64_t prefix = 0;
    size_t source = 0;
  };

  bool before(const Player& a, const Player& b) const {
    if (a.prefix == b.prefix) [[unlikely]]
      return less_(a.source, b.source);
    return a.prefix < b.prefix;
  }
  // Plays all matches below `node` and returns their winner. Nodes 1 .. n-1 are matches, n .. 2n-1
  // the sources.
  Player play(size_t node) {
    if (node >= losers_.size()) {
      const size_t source = node - losers_.size();
      return {prefix_(source), source};
    }
    const Player left = play(2 * node), right = play(2 * node + 1);
    const bool swapped = before(right, left);
    losers_[node] = swapped ? left : right;
    return swapped ? right : left;
  }

  Prefix prefix_;
  Less less_;
  std::vector<Player> losers_;  // [node]; [0] is unused
  Player winner_;
};

}  // namespace svdag
