// The receipt of a finished step of a plan: PLAN/runs/STEP.json.
//
// A receipt identifies the plan by its hash and the output by the hash of its content, which is
// also in the output's header. The output is written before the receipt, each atomically, so a
// receipt and a file with that content hash prove that the step is done, whatever the origin of the
// file. A run of another plan, of an older plan in the same folder, or of another step has another
// hash. Rejected: the plan's hash in the run (equal parts of equal scenes would have unequal runs).
#pragma once

#include <optional>
#include <string>

#include "builder/farm/plan/plan.h"

namespace svdag {

struct Receipt {
  std::string content_hash;  // content_hash_of(), builder/run/content_hash.h
  uint64_t bytes = 0;
  // Measured.
  double seconds = 0, cpu = 0;
  uint64_t memory = 0, scratch = 0;  // peaks in bytes
  bool resumed = false;              // the step continued the work of a killed process
};

enum class OutputState {
  kMissing,
  kInvalid,  // the file exists, but no receipt of this plan has its hash
  kValid,
};

std::string receipt_path(const Plan& plan, const PlanStep& step);
void write_receipt(const Plan& plan, const PlanStep& step, const Receipt& receipt);
// Returns nothing if the receipt is missing, of another plan or step, or cannot be parsed.
std::optional<Receipt> read_receipt(const Plan& plan, const PlanStep& step);

// Whether the plan's last output is there; the runs may then be removed.
bool is_finished(const Plan& plan, bool thorough);

// The state of the file `path` as the output of `step`. Reads only its header, or every byte if
// `thorough`.
OutputState output_state(const Plan& plan, const PlanStep& step, const std::string& path,
                         bool thorough);

}  // namespace svdag
