#include "builder/farm/plan/receipt.h"

#include <nlohmann/json.hpp>

#include "builder/run/content_hash.h"
#include "io/json.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint64_t kMaxReceiptBytes = 1 << 16;

}  // namespace

std::string receipt_path(const Plan& plan, const PlanStep& step) {
  return plan.path("runs/" + step.name + ".json");
}

void write_receipt(const Plan& plan, const PlanStep& step, const Receipt& receipt) {
  const Json json = {{"plan", plan.hash},
                     {"step", step.name},
                     {"content_hash", receipt.content_hash},
                     {"bytes", receipt.bytes},
                     {"seconds", receipt.seconds},
                     {"cpu_seconds", receipt.cpu},
                     {"memory_bytes", receipt.memory},
                     {"scratch_bytes", receipt.scratch},
                     {"resumed", receipt.resumed}};
  AtomicFile file(receipt_path(plan, step));
  file.append(json_text(json, 1) + "\n");
  file.commit();
}

std::optional<Receipt> read_receipt(const Plan& plan, const PlanStep& step) {
  const std::string path = receipt_path(plan, step);
  if (!name_exists(path)) return {};
  const File file = File::open_read(path);
  if (file.size() > kMaxReceiptBytes) return {};
  const std::string text = file.text();
  try {
    const Json json = Json::parse(text);
    if (json.at("plan") != plan.hash || json.at("step") != step.name) return {};
    Receipt receipt;
    receipt.content_hash = json.at("content_hash");
    receipt.bytes = whole_number<uint64_t>(json.at("bytes"));
    receipt.seconds = json.at("seconds");
    receipt.cpu = json.at("cpu_seconds");
    receipt.memory = whole_number<uint64_t>(json.at("memory_bytes"));
    receipt.scratch = whole_number<uint64_t>(json.at("scratch_bytes"));
    receipt.resumed = json.at("resumed");
    return receipt;
  } catch (const Json::exception&) {
    return {};
  } catch (const Error&) {
    return {};
  }
}

bool is_finished(const Plan& plan, bool thorough) {
  const PlanStep& last = plan.steps.back();
  return output_state(plan, last, plan.path(last.output), thorough) == OutputState::kValid;
}

OutputState output_state(const Plan& plan, const PlanStep& step, const std::string& path,
                         bool thorough) {
  if (!name_exists(path)) return OutputState::kMissing;
  const std::optional<Receipt> receipt = read_receipt(plan, step);
  if (!receipt) return OutputState::kInvalid;
  try {
    return content_hash_of(path, thorough) == receipt->content_hash ? OutputState::kValid
                                                                    : OutputState::kInvalid;
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    return OutputState::kInvalid;
  }
}

}  // namespace svdag
