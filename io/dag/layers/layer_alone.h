// One set of voxels of a file with layers, as a file without: for programs that go through whole
// sections, and for --layer.
#pragma once

#include <optional>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The nodes of `file`, which is plain, that a layer's root reaches; without `layer`, those of the
// union, or of the first layer of a file without union. Its sections are those of a bake of this
// layer alone on the same grid: removing nodes of a sorted level keeps it sorted.
DagFile layer_alone(const DagFile& file, std::optional<size_t> layer, const WorkRoom& room);

}  // namespace svdag
