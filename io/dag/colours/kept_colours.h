// Gives a file that is made of a part of another one, at its level or a coarser one, the colours
// that its cubes have there (docs/format.md, "Colours").
//
// Every covered cube of the colour level has its decoded colour; one without a voxel in the other
// file has none. At a level L below K, the colour level is the largest of K-2, K-4, ... up to L.
// Nothing is lost a second time: chunks of unchanged cubes are copied, the others are encoded
// without error, and the header keeps the error of the other file. Coarser cubes have the mean of
// what is left of them; an unchanged cube keeps its mean.
//
// Which cubes are uniform follows from the entries: the cubes of uniform ones, and those without a
// colour. So the file differs from one that is coloured from its scene.
#pragma once

#include "io/dag/colours/dag_copy.h"
#include "streaming/process/executor.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The colour level of a file of `levels` levels that is made of one with the colour level K.
constexpr uint32_t kept_colour_level(uint32_t k, uint32_t levels) {
  return k <= levels ? k : levels - (k - levels) % 2;
}

// Adds the colours of `coloured` to a copy of `dag`, whose grid has the same corner and the same or
// a coarser level. `is_part`: every voxel of `dag` is one of `coloured`, or a cube of them. Error
// (kUsage) if `dag` has layers without a union. Memory: the counts of the nodes of both, and per
// worker a few MiB. Same bytes for any number of workers.
void keep_colours(DagCopy* copy, const DagFile& dag, const DagFile& coloured, bool is_part,
                  const WorkRoom& room, Executor* executor);

}  // namespace svdag
