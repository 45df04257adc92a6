// The report of `svdag run --json`: every step, its receipt and its prediction.
#pragma once

#include <string>
#include <vector>

#include "builder/farm/engines/live_table.h"

namespace svdag {

std::string run_json(const Plan& plan, const std::vector<StepRow>& rows);
// Of one step that is done.
std::string step_json(const PlanStep& step, const Receipt& receipt, bool done_before);

}  // namespace svdag
