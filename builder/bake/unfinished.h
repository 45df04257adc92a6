#pragma once

#include <optional>

#include "builder/bake/checkpoint.h"
#include "builder/bake/description.h"
#include "builder/build.h"

namespace svdag {

// The unfinished bake of an earlier process, if config.unfinished resumes it. If it is discarded,
// the scratch folder is empty afterwards. An unfinished bake that must neither be resumed nor
// discarded is an Error (kUsage).
std::optional<SavedBake> find_unfinished(const BuildConfig& config, Workspace* workspace,
                                         Checkpoint* checkpoint, Description* description);

}  // namespace svdag
