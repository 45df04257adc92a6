// Arbitrary bytes as a plan: plan.json, index and receipts, separated by lines "---", with repaired
// hashes. An Error, or a plan whose steps, bins and
// receipts can be looked up.
#include "builder/farm/plan/leaf_bins.h"
#include "builder/farm/plan/plan.h"
#include "builder/farm/plan/receipt.h"
#include "streaming/file/checksum.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/fuzz/own_folder.h"

namespace svdag {
namespace {

constexpr std::string_view kBetween = "\n---\n";

std::string next_part(std::string_view* rest) {
  const size_t end = rest->find(kBetween);
  const std::string part(rest->substr(0, end));
  *rest = end == std::string_view::npos ? "" : rest->substr(end + kBetween.size());
  return part;
}

// Replaces the value of `key` by `hash`, if it exists and has the same length.
void put_hash(const std::string& key, const std::string& hash, std::string* json) {
  const size_t at = json->find("\"" + key + "\": \"");
  const size_t value = at + key.size() + 5;
  if (at == std::string::npos || value + hash.size() > json->size()) return;
  json->replace(value, hash.size(), hash);
}

std::string hash_of(const std::string& bytes) {
  Hasher128 hasher;
  hasher.update(std::as_bytes(std::span(bytes)));
  return to_hex(hasher.digest());
}

void try_plan(OwnFolder& folder, std::string_view rest) {
  std::string json = next_part(&rest);
  const std::string index = next_part(&rest);
  put_hash("index_hash", hash_of(index), &json);
  seal_plan(&json);
  folder.write("plan.json", json);
  folder.write("index", index);
  const Plan plan = load_plan(folder.path(), true);
  if (plan.steps.empty() || !plan.grid.is_valid()) std::abort();
  for (const PlanStep& step : plan.steps) {
    if (plan.command(step).empty()) std::abort();
    if (step.is_shard()) bins_of(plan.bins, step.cells, plan.grid.levels);
    std::string receipt = next_part(&rest);
    if (receipt.empty() || step.name != "shard-1") continue;  // a name may be anything
    put_hash("plan", plan.hash, &receipt);
    folder.write("runs/shard-1.json", receipt);
    read_receipt(plan, step);
  }
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static svdag::OwnFolder folder;
  static const bool made = std::filesystem::create_directory(folder.path() + "/runs");
  if (!made) std::abort();
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  svdag::expect_only_errors([&] { svdag::try_plan(folder, bytes); });
  return 0;
}
