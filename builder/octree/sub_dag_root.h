// Where the sub-DAG of a cube is found: what a run says of its roots, and a part of its tops.
#pragma once

#include <cstdint>

namespace svdag {

// Node `rank` of the cube's level in run `run`. The cube is a cell, part of one in which a node
// table was emptied, or the top of a part.
struct SubDagRoot {
  uint64_t morton;  // of the cube, at its level
  int32_t level;
  uint32_t run;
  uint32_t rank;
};

}  // namespace svdag
