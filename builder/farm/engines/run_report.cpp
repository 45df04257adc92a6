#include "builder/farm/engines/run_report.h"

#include <nlohmann/json.hpp>

#include "io/json.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

const char* state_name(StepState state) {
  switch (state) {
    case StepState::kDone:
      return "done";
    case StepState::kFailed:
      return "failed";
    default:
      return "waiting";
  }
}

void put_receipt(const Receipt& receipt, Json* json) {
  (*json)["bytes"] = receipt.bytes;
  (*json)["content_hash"] = receipt.content_hash;
  (*json)["seconds"] = receipt.seconds;
  (*json)["cpu_seconds"] = receipt.cpu;
  (*json)["memory_bytes"] = receipt.memory;
  (*json)["scratch_bytes"] = receipt.scratch;
  (*json)["resumed"] = receipt.resumed;
}

void put_prediction(const Prediction& p, Json* json) {
  (*json)["predicted"] = {{"seconds", p.seconds},
                          {"cpu_seconds", p.cpu},
                          {"memory_bytes", p.memory},
                          {"output_bytes", p.output},
                          {"scratch_bytes", p.scratch}};
}

}  // namespace

std::string run_json(const Plan& plan, const std::vector<StepRow>& rows) {
  Json json = {{"plan", plan.hash}, {"output", plan.path(plan.steps.back().output)}};
  for (size_t i = 0; i < rows.size(); ++i) {
    const StepRow& row = rows[i];
    Json step = {{"name", plan.steps[i].name},
                 {"state", state_name(row.state)},
                 {"exit", row.code},
                 {"attempts", row.attempts},
                 {"done_before", row.done_before}};
    if (row.receipt) put_receipt(*row.receipt, &step);
    put_prediction(plan.steps[i].predicted, &step);
    json["steps"].push_back(std::move(step));
  }
  return json_text(json, 2) + "\n";
}

std::string step_json(const PlanStep& step, const Receipt& receipt, bool done_before) {
  Json json = {{"name", step.name}, {"state", "done"}, {"done_before", done_before}};
  put_receipt(receipt, &json);
  put_prediction(step.predicted, &json);
  return json_text(json, 2) + "\n";
}

}  // namespace svdag
