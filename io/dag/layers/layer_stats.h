// What each layer of a file takes.
#pragma once

#include <vector>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

struct LayerStats {
  uint64_t nodes = 0;  // that the layer's root reaches, bricks included
  uint64_t own = 0;    // of these, reached by no other root, not even by the union's
};

// [layer], in the order of the table. One walk per root.
std::vector<LayerStats> layer_stats(const DagFile& file, const WorkRoom& room);

}  // namespace svdag
