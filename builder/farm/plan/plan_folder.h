// The folder of a plan: what is in it, and what may be in it before the plan is.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

// True if it was not there, and is now. Error (kOutput) if it cannot be made.
bool make_folder(const std::string& path);

// The plan's own three files, as paths.
std::vector<std::string> own_files(const std::string& folder);
// All files of a plan: its own, and what its steps make, with the receipts.
std::vector<std::string> files_of(const Plan& plan);

// Error (kUsage) if the folder, if there is one, holds what no planning has left in it. A planning
// that was killed may have left all but plan.json, and a plan without it may have been run;
// `output` is the name of the finished file.
void refuse_strange_files(const std::string& folder, const std::string& output);

}  // namespace svdag
