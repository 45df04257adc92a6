// A run: the reduced levels of some cells, sorted, with every child inside the run.
//
// Invariant (closed and canonical): children are 1 + ranks in the run's own next level; each level
// is strictly ascending by NodeKey (bricks as numbers). Runs of different workers, processes and
// machines therefore agree on the order of the nodes they share, which is all that the merge needs.
// A level stands in memory, in a scratch file if the run was spilled, or in a run file that was
// made elsewhere (builder/run/run_file.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "builder/reduce/node_table.h"
#include "streaming/memory/huge_vector.h"
#include "streaming/spill/spill_file.h"

namespace svdag {

class RunFile;

template <class Key>
struct RunLevel {
  HugeVector<Key> keys;                   // empty if spilled
  MemoryBudget::Reservation reservation;  // of these
  std::optional<SpillStream> spilled;     // the keys as bytes
  const RunFile* file = nullptr;          // holds the keys
};

struct Run {
  RunLevel<Brick> bricks;
  std::vector<RunLevel<NodeKey>> nodes;  // [level], 0 .. L-3
};

// A node of a table by level and number.
struct NodeNumber {
  int level;
  uint32_t number;
};

// Where a run is spilled to: a stream number per level, from `first_stream` on.
struct SpillTarget {
  SpillFile* file;
  uint64_t first_stream;
};

// Empties `table` and sorts what `roots` reach, level by level from the bricks up. The rest goes:
// the plane memo (builder/descend/plane_memo.h) adds nodes to answers that it then takes back.
// Turns the numbers of `roots` into ranks. Spills the run if there is a target.
Run freeze(NodeTable* table, std::span<NodeNumber> roots, const SpillTarget* target = nullptr);

// Upper bound of the memory that `table` takes until it has been frozen and spilled.
uint64_t freeze_bytes(const NodeTable& table);

}  // namespace svdag
