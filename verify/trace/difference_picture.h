// A picture of two DAGs at once: voxels of both in grey, of only A in red, of only B in blue.
//
// Each camera ray is traced through both DAGs. The nearer hit is shown; at the same time both have
// the voxel. No third DAG is built.
#pragma once

#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/trace/cpu.h"

namespace svdag {

// Both DAGs must have the same number of levels. Of `config`, size and supersampling are used.
Image render_difference(const DagView& a, const DagView& b, const Camera& camera,
                        const Shading& shading, const RenderConfig& config, Executor& executor,
                        Progress& progress);

}  // namespace svdag
