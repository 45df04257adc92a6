// What says that a step of a plan was done: its receipt, PLAN/runs/STEP.json.
//
// A receipt names the plan by its hash and the output by the hash of its content, which the output
// itself bears in its header. It is written after the output, each at once or not at all, so
// whoever finds a receipt and a file of that content has what the step makes, wherever the file
// came from; a run of another plan, of an older one in the same folder, or of another step has
// another hash. Rejected: the plan's hash in the run (equal parts of equal scenes would have
// unequal runs).
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
// None if there is none, or it is of another plan or cannot be read.
std::optional<Receipt> read_receipt(const Plan& plan, const PlanStep& step);

// Looks at the file `path` as the output of `step`: at its header alone, or at every byte.
OutputState state_of(const Plan& plan, const PlanStep& step, const std::string& path,
                     bool thorough);

}  // namespace svdag
