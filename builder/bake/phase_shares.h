// The share of a bake's time that each phase takes, roughly, for the progress line. A phase covers
// [begin, end) of the whole.
//
// Notation: T triangles, N^3 voxels. Times are relative to the split of a scene. Voxelizing takes
//
//   2.5 N / sqrt(T)
//
// of them: right within a factor of three for scans and hair. For walls it is up to ten times too
// long, but beside it the split is nothing. Runs that are spilled were sorted while others were
// voxelized.
//
// Rejected: one table for all scenes (the remaining time of a scan of 10^9 triangles was four times
// too long).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace svdag {

struct PhaseShare {
  double begin = 0, end = 0;
};

struct PhaseShares {
  PhaseShare bounds, split, voxelize, sort, merge, write;
};

struct ExpectedWork {
  uint64_t triangles = 0;  // 0: unknown
  int levels = 0;
  bool reads_scene = true;  // else it is split already
  bool spills = false;
};

inline PhaseShares phase_shares(const ExpectedWork& work) {
  constexpr double kUnknown = 10;  // times as long as the split
  const double reading = work.reads_scene ? 1 : 0;
  const double voxelize =
      work.triangles == 0
          ? kUnknown
          : 2.5 * std::sqrt(std::ldexp(1, 2 * work.levels) / double(work.triangles));
  const double times[] = {0.3 * reading,
                          reading,
                          voxelize,
                          (work.spills ? 0.01 : 0.15) * voxelize,
                          (work.spills ? 0.05 : 0.09) * voxelize,
                          0.01 * voxelize};
  PhaseShares shares;
  PhaseShare* const all[] = {&shares.bounds, &shares.split, &shares.voxelize,
                             &shares.sort,   &shares.merge, &shares.write};
  double sum = 0, before = 0;
  for (const double time : times) sum += time;
  for (size_t i = 0; i < std::size(all); ++i) {
    const double end = before + times[i];
    *all[i] = {before / sum, std::min(end / sum, 1.0)};
    before = end;
  }
  return shares;
}

}  // namespace svdag
