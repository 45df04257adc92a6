// The receipt of a finished step of a plan: PLAN/runs/STEP.json.
//
// A receipt identifies the plan by its hash and the output by the hash of its content, which is
// also in the output's header. Output and receipt are written in this order, each atomically, so a
// receipt and a file of that content prove the step done, whatever the file's origin; a run of
// another plan, of an older one in the same folder, or of another step has another hash. Rejected:
// the plan's hash in the run (equal parts of equal scenes would have unequal runs).
#pragma once

#include <optional>
#include <string>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct Receipt {
  std::string content_hash;  // 32 hex digits
  uint64_t bytes = 0;
  // Measured.
  double seconds = 0, cpu = 0;
  uint64_t memory = 0, scratch = 0;  // peaks in bytes
};

enum class OutputState {
  kMissing,  // no file
  kInvalid,  // a file, but not known to be what this step of this plan makes
  kValid,
};

std::string receipt_path(const Plan& plan, const PlanStep& step);
void write_receipt(const Plan& plan, const PlanStep& step, const Receipt& receipt);
// None if the receipt does not exist, is of another plan, or cannot be read.
std::optional<Receipt> read_receipt(const Plan& plan, const PlanStep& step);

// Looks at the file `path` as the output of `step`: at its header alone, or at every byte.
OutputState state_of(const Plan& plan, const PlanStep& step, const std::string& path,
                     bool thorough);

}  // namespace svdag
