// What a judge says about one triangle, as a set of voxels.
#pragma once

#include "tests/verify/rational_judge.h"
#include "verify/judge/judge.h"

namespace svdag {

inline VoxelSet judged_voxels(Judge& judge, const LatticeTriangle& t, int shift,
                              const VoxelBox& window) {
  VoxelSet voxels;
  judge.voxels(t, shift, window, [&](const CellRun& run) {
    LatticePoint p = run.first;
    for (int64_t i = 0; i < run.count; ++i, ++p[run.axis]) voxels.emplace(p.x, p.y, p.z);
  });
  return voxels;
}

// By the integer judge of the rule thin.
inline VoxelSet thin_set(const LatticeTriangle& t, int shift, const VoxelBox& window) {
  return judged_voxels(*make_judge({JudgeChoice::Kind::kInteger, Rule::kThin}), t, shift, window);
}

}  // namespace svdag
