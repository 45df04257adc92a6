// The commands of `svdag-verify`: the command line is parsed to one of these structs, and main()
// executes it with the run() of its header.
#pragma once

#include <variant>

#include "verify/commands/check.h"
#include "verify/commands/diff.h"
#include "verify/commands/mesh.h"
#include "verify/commands/render.h"
#include "verify/commands/report.h"
#include "verify/commands/trace.h"
#include "verify/commands/vdb.h"
#include "verify/commands/view.h"

namespace svdag {

using VerifyCommand = std::variant<CheckConfig, MeshConfig, DiffConfig, VdbConfig, TraceConfig,
                                   RenderCommandConfig, ReportConfig, ViewConfig>;

}  // namespace svdag
