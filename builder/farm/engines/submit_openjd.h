// A plan as an Open Job Description template (specification 2023-09), for render farms.
//
// The template has one step for all shards, whose tasks are their numbers, and one per level of the
// merge tree, whose tasks are the merges. Host requirements request memory and threads. The farm
// retries failed tasks (docs/farm.md lists the exit codes).
#pragma once

#include <string>
#include <vector>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct OpenJdConfig {
  std::string program;  // svdag on the hosts; empty: this program
  std::string scratch;  // passed on to the steps
  std::string path;     // of the template: its default for the plan is relative to its folder
};

// The template as JSON text. Paths that are not valid UTF-8 are an Error (kUsage).
std::string openjd_template(const Plan& plan, const OpenJdConfig& config);

}  // namespace svdag
