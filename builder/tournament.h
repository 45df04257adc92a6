// Which of many sorted sources has the smallest head: a tree of losers (Knuth, TAOCP 3, 5.4.1).
//
// Every inner node remembers the loser of the match that was played there, so replacing the winner
// costs one comparison per level, up the path from its leaf. Rejected: a binary heap (two comparisons per
// level), a linear search (linear in sources: fine for three, not for three hundred).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace svdag {

// `less(a, b)`: whether source a goes before source b. A source that has ended goes after all.
template <class Less>
class Tournament {
 public:
  Tournament(size_t sources, Less less) : less_(less), losers_(sources) {
    if (sources > 1) winner_ = play(1);
  }

  // The source that goes first.
  size_t winner() const { return winner_; }
  // To be called when the winner's head has changed.
  void replay() {
    size_t contender = winner_;
    for (size_t node = (contender + losers_.size()) / 2; node > 0; node /= 2) {
      if (less_(losers_[node], contender)) std::swap(losers_[node], contender);
    }
    winner_ = contender;
  }

 private:
  // Nodes 1 .. n-1 are matches, n .. 2n-1 the sources.
  size_t play(size_t node) {
    if (node >= losers_.size()) return node - losers_.size();
    size_t left = play(2 * node), right = play(2 * node + 1);
    if (less_(right, left)) std::swap(left, right);
    losers_[node] = right;
    return left;
  }

  Less less_;
  std::vector<size_t> losers_;  // [0] is not used
  size_t winner_ = 0;
};

}  // namespace svdag
