// The share of a bake's time that each phase takes, roughly, for the progress line: measured on
// scans and buildings at 8K to 64K. A phase covers [begin, end) of the whole.
#pragma once

namespace svdag {

struct PhaseShare {
  double begin, end;
};

constexpr PhaseShare kBoundsShare{0, 0.05};
constexpr PhaseShare kSplitShare{0.05, 0.1};
constexpr PhaseShare kVoxelizeShare{0.1, 0.8};
constexpr PhaseShare kSortShare{0.8, 0.85};
constexpr PhaseShare kMergeShare{0.85, 0.98};
constexpr PhaseShare kWriteShare{0.98, 1};

}  // namespace svdag
