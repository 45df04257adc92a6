// The cut-out triangles among the triangles of a batch, a bin or a tree.
//
// A LatticeTriangle with `cut` != 0 is cut: record cut - 1 of the records that travel with it says
// where it is in the texture of which material. So triangles that are whole stay as they were.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/scene/cutouts/cut_out.h"
#include "io/triangle.h"
#include "streaming/error.h"

namespace svdag {

struct CutRecord {
  TextureCorners corners;
  uint32_t material = 0;  // an index of CutOuts
};
using CutRecords = std::vector<CutRecord>;
using CutOuts = std::vector<CutOut>;  // of the materials of a scene, each once

struct CutScene {
  CutOuts cut_outs;
  CutRecords records;
};

// The number of a material among those before, or as the next one.
inline uint32_t material_number(const CutOut& cut, CutOuts* all) {
  const auto found = std::ranges::find(*all, cut);
  if (found != all->end()) return uint32_t(found - all->begin());
  all->push_back(with_map(cut));
  return uint32_t(all->size() - 1);
}
// Null: the triangle is whole.
inline const CutRecord* cut_record_of(const LatticeTriangle& t, const CutRecords& records) {
  return t.cut == 0 ? nullptr : &records[t.cut - 1];
}
// The `cut` of the triangle of the record, which it adds.
inline uint32_t add_record(const CutRecord& record, CutRecords* records) {
  if (records->size() == kMaxCut)
    throw Error(ExitCode::kMemory,
                "more than 2^30 cut-out triangles at once: use less memory (-m)");
  records->push_back(record);
  return uint32_t(records->size());
}
// The triangle as one of `records`, which holds its record from now on.
inline LatticeTriangle with_record(const LatticeTriangle& t, const CutRecord& record,
                                   CutRecords* records) {
  LatticeTriangle result = t;
  result.cut = add_record(record, records) & kMaxCut;
  return result;
}

}  // namespace svdag
