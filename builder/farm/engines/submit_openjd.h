// Writes a plan as an Open Job Description template (specification 2023-09), for render farms.
//
// The template has one step for all shards and one per level of the merge tree, with a task per
// shard or merge. Host requirements request memory and threads. The farm retries failed tasks
// (docs/farm.md lists the exit codes).
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct OpenJdConfig {
  std::string program;  // svdag on the hosts; empty: this program
  std::string scratch;  // --scratch of the steps
  std::string path;     // of the template; the path of the plan in it is relative to its folder
};

// The template as JSON text. Throws Error (kUsage) if a path is not valid UTF-8.
std::string openjd_template(const Plan& plan, const OpenJdConfig& config);

}  // namespace svdag
