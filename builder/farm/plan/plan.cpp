#include "builder/farm/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "builder/bake/description.h"
#include "builder/farm/plan/plan_index.h"
#include "builder/farm/plan/step_name.h"
#include "io/dag/grid_fields.h"
#include "io/json.h"
#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPlanJson = "plan.json";
// Changes with the keys of plan.json and the contents of the index and the bins.
constexpr int kFormat = 11;

constexpr size_t kHashDigits = 32;

constexpr const char* kOtherVersion =
    "written by another version of svdag: create the plan again with svdag plan";

[[noreturn]] void fail_plan(const Plan& plan, const std::string& sentence) {
  fail_input(plan.path(kPlanJson), sentence);
}

uint64_t count_of(const Json& json, const char* key) {
  return whole_number<uint64_t>(json.at(key));
}

struct PutJson {
  Json* out;

  template <class T>
  void operator()(const char* name, const T& value) const {
    (*out)[name] = value;
  }
  void operator()(const char* name, Grid::Kind kind) const { (*out)[name] = kind_name(kind); }
  void operator()(const char* name, const Affine& a) const { (*out)[name] = a.m; }
  void operator()(const char* name, const Point& v) const { (*out)[name] = {v.x, v.y, v.z}; }
  void operator()(const char* name, const LatticePoint& v) const { (*out)[name] = {v.x, v.y, v.z}; }
};

struct GetJson {
  const Json& in;
  const Plan& plan;

  void operator()(const char* name, double& value) const { value = in.at(name); }
  void operator()(const char* name, bool& value) const { value = in.at(name); }
  void operator()(const char* name, int& value) const { value = whole_number<int>(in.at(name)); }
  void operator()(const char* name, uint64_t& value) const { value = count_of(in, name); }
  void operator()(const char* name, Grid::Kind& kind) const {
    const std::string text = in.at(name);
    const auto found = std::find(std::begin(kGridKindNames), std::end(kGridKindNames), text);
    if (found == std::end(kGridKindNames)) fail_plan(plan, "unknown kind of grid (" + text + ")");
    kind = Grid::Kind(found - std::begin(kGridKindNames));
  }
  void operator()(const char* name, Affine& a) const { in.at(name).get_to(a.m); }
  void operator()(const char* name, Point& v) const {
    for (int a = 0; a < 3; ++a) v[a] = in.at(name).at(size_t(a));
  }
  void operator()(const char* name, LatticePoint& v) const {
    for (int a = 0; a < 3; ++a) v[a] = whole_number<int64_t>(in.at(name).at(size_t(a)));
  }
};

std::string hash_of(const std::string& text) {
  Hasher128 hasher;
  hasher.update(std::as_bytes(std::span(text)));
  return to_hex(hasher.digest());
}

double rounded(double seconds) {
  return std::round(1000 * seconds) / 1000;
}

Json prediction_json(const Prediction& p) {
  return {{"cpu_seconds", rounded(p.cpu)}, {"seconds", rounded(p.seconds)},
          {"budget_bytes", p.budget},      {"memory_bytes", p.memory},
          {"output_bytes", p.output},      {"scratch_bytes", p.scratch}};
}

Prediction get_prediction(const Json& json) {
  return {json.at("cpu_seconds"),         json.at("seconds"),
          count_of(json, "budget_bytes"), count_of(json, "memory_bytes"),
          count_of(json, "output_bytes"), count_of(json, "scratch_bytes")};
}

Json one_bake_json(const OneBake& bake) {
  return {{"cpu_seconds", rounded(bake.cpu)},
          {"voxelize_seconds", rounded(bake.voxelize)},
          {"memory_bytes", bake.memory},
          {"cells", bake.cells}};
}

OneBake get_one_bake(const Json& json) {
  return {json.at("cpu_seconds"), json.at("voxelize_seconds"), count_of(json, "memory_bytes"),
          count_of(json, "cells")};
}

Json step_json(const Plan& plan, const PlanStep& step) {
  Json json = {{"name", step.name}};
  if (step.is_shard()) {
    json["cells"] = {
        {"level", step.cells.level}, {"begin", step.cells.begin}, {"end", step.cells.end}};
    json["triangles"] = step.triangles;
  } else {
    for (const size_t i : step.inputs) json["inputs"].push_back(plan.steps[i].name);
  }
  json["output"] = step.output;
  json["threads"] = step.threads;
  json["command"] = {"svdag"};
  for (const std::string& word : plan.command(step)) json["command"].push_back(word);
  json["predicted"] = prediction_json(step.predicted);
  return json;
}

// Steps write only into the folder of their plan, even if the plan was forged.
bool stays_inside(const std::string& path) {
  const std::string parts = "/" + path + "/";
  return !path.empty() && path[0] != '/' && parts.find("/../") == std::string::npos &&
         path.find('\0') == std::string::npos;
}

PlanStep get_step(const Json& json, const Plan& plan) {
  PlanStep step;
  step.name = json.at("name");
  step.output = json.at("output");
  if (!stays_inside(step.output) || step.name.find('/') != std::string::npos)
    fail_plan(plan, "step " + step.name + " writes outside the plan folder (" + step.output + ")");
  step.threads = count_of(json, "threads");
  if (step.threads < 1 || step.threads > kMaxThreads)
    fail_plan(plan, "step " + step.name + " has an invalid number of threads (" +
                        std::to_string(step.threads) + ")");
  step.predicted = get_prediction(json.at("predicted"));
  if (json.contains("cells")) {
    const Json& cells = json.at("cells");
    step.cells = {whole_number<int>(cells.at("level")), count_of(cells, "begin"),
                  count_of(cells, "end")};
    step.triangles = count_of(json, "triangles");
    const int level = step.cells.level;
    if (level < 0 || level > plan.grid.levels - 2 || step.cells.begin > step.cells.end ||
        step.cells.end > uint64_t(1) << 3 * level)
      fail_plan(plan, "the cells of step " + step.name + " are not in the grid");
    if (!is_shard_name(step.name))
      fail_plan(plan, "shard " + step.name + ": its name does not begin with " + kShardPrefix);
    return step;
  }
  for (const Json& name : json.at("inputs")) {
    const auto input = std::find_if(plan.steps.begin(), plan.steps.end(),
                                    [&](const PlanStep& other) { return other.name == name; });
    if (input == plan.steps.end())
      fail_plan(plan, "step " + step.name + " reads the output of " + name.get<std::string>() +
                          ", which is not an earlier step");
    step.inputs.push_back(size_t(input - plan.steps.begin()));
  }
  if (step.inputs.empty()) fail_plan(plan, "merge " + step.name + " has no inputs");
  if (step.is_colours() && (!plan.colours || step.inputs.size() != 1))
    fail_plan(plan, "step " + step.name + " does not add the colours of the plan to one file");
  return step;
}

Rule get_rule(const Json& json, const Plan& plan) {
  const auto rule = rule_named(json.get<std::string>());
  if (rule && rule != Rule::kPoints) return *rule;
  fail_plan(plan, "unknown rule " + json.dump());
}

void parse(const std::string& text, Plan* plan, std::string* index_hash) {
  const Json json = Json::parse(text);
  if (json.at("format") != kFormat) fail_plan(*plan, kOtherVersion);
  std::string sealed = text;
  plan->hash = seal_plan(&sealed);
  if (sealed != text)
    fail_plan(*plan, "was changed after it was planned: create the plan again with svdag plan");
  for (const Json& input : json.at("inputs"))
    plan->inputs.push_back({input.at("path"), count_of(input, "bytes"), input.at("hash")});
  plan->description = json.at("description");
  if (!is_of_this_algorithm(plan->description)) fail_plan(*plan, kOtherVersion);
  visit_fields(plan->grid, GetJson{json.at("grid"), *plan});
  if (!plan->grid.is_valid()) fail_plan(*plan, "invalid grid");
  plan->content.rule = get_rule(json.at("rule"), *plan);
  if (!describes(plan->description, plan->content.rule, plan->grid))
    fail_plan(*plan, "rule and grid are not those of the description");
  visit_count_fields(plan->counts, GetJson{json.at("scene"), *plan});
  plan->one_bake = get_one_bake(json.at("one_bake"));
  if (json.contains("colours")) plan->colours = get_colours(json.at("colours"));
  *index_hash = json.at("index_hash");
  for (const Json& step : json.at("steps")) plan->steps.push_back(get_step(step, *plan));
  if (plan->steps.empty()) fail_plan(*plan, "the plan has no steps");
}

std::string without_slashes(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

}  // namespace

size_t Plan::shards() const {
  return size_t(std::count_if(steps.begin(), steps.end(),
                              [](const PlanStep& step) { return step.is_shard(); }));
}

std::vector<std::string> Plan::command(const PlanStep& step) const {
  return {"run", folder, "--step", step.name};
}

void require_utf8(const std::string& path) {
  try {
    (void)Json(path).dump();
  } catch (const Json::type_error&) {
    fail_usage(
        path +
        ": the file name is not valid UTF-8 and cannot be stored in a plan: rename the file");
  }
}

bool is_plan(const std::string& path) {
  return name_exists(path + "/" + kPlanJson);
}

std::string plan_json(const Plan& plan, const std::string& index_hash) {
  Json json = {{"svdag", "plan"}, {"format", kFormat}};
  for (const PlanInput& input : plan.inputs)
    json["inputs"].push_back({{"path", input.path}, {"bytes", input.bytes}, {"hash", input.hash}});
  json["description"] = plan.description;
  visit_fields(plan.grid, PutJson{&json["grid"]});
  json["rule"] = rule_name(plan.content.rule);
  visit_count_fields(plan.counts, PutJson{&json["scene"]});
  if (plan.colours) json["colours"] = colours_json(*plan.colours);
  json["one_bake"] = one_bake_json(plan.one_bake);
  json["bins"] = plan.bins.size();
  json["index_hash"] = index_hash;
  for (const PlanStep& step : plan.steps) json["steps"].push_back(step_json(plan, step));
  json["hash"] = std::string(kHashDigits, '0');
  return json.dump(1) + "\n";
}

std::string seal_plan(std::string* json) {
  const std::string key = "\"hash\": \"";
  const size_t at = json->rfind(key);
  if (at == std::string::npos || json->size() - at < key.size() + kHashDigits) return "";
  json->replace(at + key.size(), kHashDigits, kHashDigits, '0');
  const std::string hash = hash_of(*json);
  json->replace(at + key.size(), kHashDigits, hash);
  return hash;
}

void save_plan(Plan* plan) {
  std::string text = plan_json(*plan, save_index(*plan));
  plan->hash = seal_plan(&text);
  AtomicFile file(plan->path(kPlanJson));
  file.append(text);
  file.commit();
}

Plan load_plan(const std::string& folder, bool with_bins) {
  Plan plan;
  plan.folder = without_slashes(absolute_path(without_slashes(folder)));
  const std::string path = plan.path(kPlanJson);
  if (!is_plan(folder))
    fail_input(folder, "not a plan folder: plan.json is missing (create one with svdag plan)");
  const std::string text = File::open_read(path).text();
  std::string index_hash;
  try {
    parse(text, &plan, &index_hash);
  } catch (const Json::parse_error& error) {
    throw Error(ExitCode::kBadInput, "is damaged: it is not valid JSON", path, error.byte);
  } catch (const Json::exception& error) {
    fail_input(path, std::string("is damaged: ") + error.what());
  } catch (const Error& error) {
    if (!error.path().empty()) throw;
    fail_input(path, error.what());  // from io/json.h
  }
  if (with_bins) load_index(index_hash, &plan);
  return plan;
}

const PlanStep& find_step(const Plan& plan, const std::string& name) {
  for (const PlanStep& step : plan.steps) {
    if (step.name == name) return step;
  }
  fail_usage("the plan has no step " + name + ": svdag info PLAN --levels lists its steps");
}

}  // namespace svdag
