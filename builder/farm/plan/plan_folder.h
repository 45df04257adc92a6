// The folder of a plan: its files, and the files that planning accepts in it.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

// Creates the folder; returns false if it exists. Throws Error (kOutput) if it cannot be created.
bool make_folder(const std::string& path);

// Paths of plan.json, the index and the triangles.
std::vector<std::string> own_files(const std::string& folder);
// All files of a plan: own_files(), outputs of steps and receipts.
std::vector<std::string> files_of(const Plan& plan);

// Throws Error (kUsage) if the folder exists and holds files that do not belong to a plan. A killed
// planner may have left everything but plan.json, and if plan.json was removed, the plan may have
// been run. `output` is the name of the finished file.
void reject_foreign_files(const std::string& folder, const std::string& output);

}  // namespace svdag
