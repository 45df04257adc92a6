// Proves that a valid file in the plain layout is *the* DAG of its voxels: canonical, minimal, and
// described correctly by its header.
//
// DagFile::open proves that the bytes are unchanged and that all pointers are valid. This proves
// the rest, in one pass per level from the bricks up, again without trusting a pointer:
//   * no brick and no node is empty;
//   * bricks ascend as numbers; nodes ascend by their eight children, child 0 first, 0 for none and
//     1 + index else. Strictly ascending means that no two are equal, so the DAG is reduced;
//   * every node but the root is a node's child, and the root's level has one node. A reduced DAG
//     without unused nodes is minimal;
//   * the voxels summed over the DAG equal the header's, and none is outside the selection;
//   * the union of a surface rule is exactly the voxels of the layers (union_check.h);
//   * the metadata matches the header, with every key once, in the format's exact words;
//   * without its colours the file has its content hash, and the colours have theirs; each entry of
//     them is a cube of the DAG, each mean possible (integrity_colours.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

struct IntegrityReport {
  uint64_t voxels = 0;               // counted, not read from the header
  std::vector<uint64_t> nodes;       // counted, per level; the last are bricks
  std::vector<std::string> defects;  // one sentence each, at most one of a kind per level

  bool sound() const { return defects.empty(); }
};

// `dag`: of a plain file.
IntegrityReport inspect(const Header& header, const DagView& dag, std::string_view metadata,
                        const LayerTable& layers = {});

// The same for a file in any layout. A compact file is proved by its plain form, and by having the
// bytes that this gives in the compact layout. Error (kBadInput) if it has no plain form.
IntegrityReport inspect_file(const DagFile& file, const WorkRoom& room);

// Whether the entries of the colours are those of the definition (docs/format.md, "Colours"), as
// far as they follow from the voxels, and their hash. `file` must have colours.
std::vector<std::string> colour_defects(const DagFile& file, MemoryBudget* budget);

// The differences between the JSON text of the metadata and the header.
std::vector<std::string> metadata_defects(const Header& header, std::string_view metadata);

}  // namespace svdag
