// A run: the reduced levels of some cells, sorted, with every child inside the run.
//
// Invariant (closed and canonical): children are 1 + ranks in the run's own next level; each level
// is strictly ascending by NodeKey (bricks as numbers). Runs of different workers, processes and
// machines therefore agree on the order of the nodes they share, which is all that the merge needs.
// A level is held in memory, in a scratch file (if the run was spilled), or in a .run file
// (builder/run/run_file.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "builder/octree/sub_dag_root.h"
#include "builder/reduce/node_table.h"
#include "builder/workspace/scratch.h"
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

// Where a run is spilled: one stream per level, numbered from `first_stream`.
struct SpillTarget {
  SpillFile* file;
  uint64_t first_stream;
};
inline SpillTarget new_target(Scratch* scratch, int levels) {
  return {scratch->runs(), scratch->new_streams(uint64_t(levels))};
}

// Empties `table` and sorts the nodes that `roots` reach, level by level from the bricks up. Others
// are dropped: the plane memo (builder/descend/plane_memo.h) adds nodes for answers that it then
// withdraws. Replaces the table number in each root's `rank` by the rank. Spills the run to
// `target`, if given.
Run freeze(NodeTable* table, std::span<SubDagRoot> roots, const SpillTarget* target = nullptr);

// Upper bounds of the memory of a key in a table that is frozen: the key, and its slots or two sort
// records and a rank, whichever is more.
constexpr uint64_t kFreezeBytesPerBrick = 44, kFreezeBytesPerNode = 68;

// Upper bound of the memory that `table` takes until it is frozen and spilled, in bytes.
uint64_t freeze_bytes(const NodeTable& table);

}  // namespace svdag
