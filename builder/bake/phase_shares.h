// The share of a bake's time that each phase takes, roughly, for the progress line: between those
// that `svdag build -v` prints for Sponza, the dragon and a terrain at 8K and 16K. A phase covers
// [begin, end) of the whole.
#pragma once

namespace svdag {

struct PhaseShare {
  double begin, end;
};

constexpr PhaseShare kBoundsShare{0, 0.01};
constexpr PhaseShare kSplitShare{0.01, 0.06};
constexpr PhaseShare kVoxelizeShare{0.06, 0.82};
constexpr PhaseShare kSortShare{0.82, 0.92};
constexpr PhaseShare kMergeShare{0.92, 0.98};
constexpr PhaseShare kWriteShare{0.98, 1};

}  // namespace svdag
