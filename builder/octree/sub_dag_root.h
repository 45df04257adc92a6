// The location of the sub-DAG of a cube: a root of a run, or a top of a grid part.
#pragma once

#include <cstdint>

#include "builder/octree/subject.h"

namespace svdag {

// Node `rank` of the cube's level in run `run`. The cube is a cell, a cube in a cell in which a
// node table was emptied, or a top of a grid part.
struct SubDagRoot {
  uint64_t morton;  // of the cube, at its level
  int32_t level;
  uint32_t run;
  uint32_t rank;
  SubDagSets sets = {};
};

}  // namespace svdag
