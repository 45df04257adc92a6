// Encodes the colours of a chunk (io/dag/colours/chunk_view.h).
//
// The decoded colours differ from the given ones by at most the error: the Euclidean distance of
// the 8-bit sRGB colours, judged by one integer function when a run is searched and when it is
// written. A colour that is none stays none. The same colours give the same words.
//
// The runs are the cheapest of those that end at most 256 colours after they begin and of which the
// search finds ends. If a run fits, so do its parts, with the same ends. So per kind two pointers
// find the longest run that ends at each colour, and a sliding minimum over its starts its cost:
// dynamic programming in O(colours x kinds). (Greedy runs take 23 % more.) The ends that fit the
// run one colour shorter are tried first, which spares most searches.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "io/dag/colours/chunk_view.h"

namespace svdag {

// The bits of a run besides its payload, as the search counts them: the header and 1/16 of a group.
constexpr uint32_t kRunCost = kRunHeaderBits + 2;

class ChunkEncoder {
 public:
  // `max_squared`: the square of the error; 0 is lossless.
  explicit ChunkEncoder(uint32_t max_squared) : max_squared_(int32_t(max_squared)) {}

  // Appends the words of a chunk of 1 .. kChunkColours colours, of which none may be kNoColour.
  void encode(std::span<const uint32_t> colours, std::vector<uint32_t>* words);

  // Of the last chunk, for tests and figures. Its cost in bits, without the number of runs and
  // padding.
  uint32_t cost() const { return cost_.back(); }
  // The least start of a run of `kind` that ends before colour `end`; `end` if there is none.
  uint32_t first_start(uint32_t kind, uint32_t end) const { return first_[kind][end]; }

 private:
  // The ends of a line in 6 bits a channel, or a constant in 8 bits: b is then unused.
  struct Ends {
    std::array<uint8_t, 3> a{}, b{};
  };
  struct Moments {
    std::array<int64_t, 3> sum{};
    std::array<int64_t, 6> product{};  // rr, rg, rb, gg, gb, bb
  };
  struct Line;  // through colours: their main direction

  void find_windows();
  void find_window(uint32_t kind, uint32_t end);
  bool search(uint32_t kind, uint32_t begin, uint32_t end, Ends* ends) const;
  // Calls visit(ends) with candidates until it returns true.
  template <class Visit>
  bool for_candidates(uint32_t kind, uint32_t begin, uint32_t end, bool all,
                      const Visit& visit) const;
  // Sum of the squared errors; -1 if one is more than allowed. The one judge of errors.
  int64_t squared_error(uint32_t kind, uint32_t begin, uint32_t end, const Ends& ends) const;
  Line line_through(uint32_t begin, uint32_t end) const;
  void find_runs();
  void emit(std::vector<uint32_t>* words) const;
  Ends refitted(uint32_t kind, uint32_t begin, uint32_t end, const Ends& ends) const;
  Ends best_ends(uint32_t kind, uint32_t begin, uint32_t end) const;

  int32_t max_squared_;
  std::span<const uint32_t> colours_;
  uint32_t count_ = 0;
  std::array<std::vector<int32_t>, 3> channel_;
  std::vector<Moments> moments_;                        // of the colours before
  std::array<std::vector<uint32_t>, kRunKinds> first_;  // [kind][end]
  std::array<std::vector<Ends>, kRunKinds> ends_;       // of the longest run
  std::array<std::vector<unsigned char>, kRunKinds> has_ends_;
  std::vector<uint32_t> cost_, run_start_;  // [end]: of the cheapest runs
  std::vector<uint8_t> run_kind_;
  std::vector<uint32_t> barrier_;  // [end]: the first colour after the last kNoColour before end
};

// All colours of a valid chunk, in order. The word after the chunk must be readable.
void decode_chunk(const uint32_t* words, std::span<uint32_t> colours);

}  // namespace svdag
