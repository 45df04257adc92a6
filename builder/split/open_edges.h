// Finds the open edges of a scene that is not closed, to report them.
//
// An open interval of a line is what is left of its directed edges (io/scene/boundary_chain.h); it
// has two ends. The ends are found in two passes over the scene with little memory: the first sums
// them up by hash in buckets, almost all of which come out as zero; the second keeps the ends in
// the other buckets. Rejected: an external sort of all edges.
#pragma once

#include <string>
#include <vector>

#include "io/grid.h"
#include "io/scene/scene.h"

namespace svdag {

struct OpenEdges {
  uint64_t edges = 0;              // open intervals; if closed_mod_2, passed twice in one direction
  bool closed_mod_2 = false;       // closed if the orientation of triangles does not matter
  bool all_counted = true;         // false: there are more
  Point first{0};                  // an end of the first, in the order of the scene
  std::vector<std::string> parts;  // names of the objects that have some, in the order of the scene
};

// Reads the scene twice; it is snapped to `grid`.
OpenEdges find_open_edges(const Scene& scene, const Grid& grid);

// "3 open edges in lid, the first at (0, 1, 2)".
std::string describe(const OpenEdges& open);

}  // namespace svdag
