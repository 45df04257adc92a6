// The colour of one cube, as the triangles that meet it are added (builder/colours/cube_share.h).
#pragma once

#include <array>
#include <cstdint>

#include "builder/colours/cube_share.h"
#include "io/dag/colours/cube_colour.h"

namespace svdag {

class CubeSum {
 public:
  bool empty() const { return triangles_ == 0; }
  // Whether nearest points decide, as far as added.
  bool has_area() const { return area_.weight != 0; }

  // `share`: of a triangle that meets the cube. `one_colour`: all its points have that colour.
  void add(const CubeShare& share, bool one_colour) {
    is_constant_ = one_colour && (triangles_ == 0 || (is_constant_ && share.colour == first_));
    if (triangles_++ == 0) first_ = share.colour;
    area_.add(share, share.area);
  }
  // The share of its nearest point.
  void add_nearest(const CubeShare& share) {
    opaque_.add(share, share.area);
    all_.add(share, 1);
  }
  // Of the cube `morton` of `level`; at least one triangle was added.
  CubeColour colour(uint64_t morton, int level) const {
    CubeColour result{morton, uint8_t(level), true, is_constant_, {}};
    const Mean& mean = area_.weight != 0 ? area_ : opaque_.weight != 0 ? opaque_ : all_;
    for (size_t c = 0; c < 3; ++c) result.linear[c] = is_constant_ ? first_[c] : mean.rounded(c);
    return result;
  }

 private:
  struct Mean {
    unsigned __int128 weight = 0, sum[3] = {0, 0, 0};

    void add(const CubeShare& share, uint64_t by) {
      weight += by;
      for (size_t c = 0; c < 3; ++c) sum[c] += (unsigned __int128)(by)*share.colour[c];
    }
    uint16_t rounded(size_t c) const {
      return weight == 0 ? uint16_t(0) : uint16_t((2 * sum[c] + weight) / (2 * weight));
    }
  };

  Mean area_, opaque_, all_;
  uint64_t triangles_ = 0;
  bool is_constant_ = false;
  std::array<uint16_t, 3> first_{};
};

}  // namespace svdag
