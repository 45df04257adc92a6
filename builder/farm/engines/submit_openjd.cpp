#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "builder/farm/engines/farm_engine.h"
#include "builder/farm/plan/step_name.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMinTimeout = 600;                          // seconds
constexpr const char* kNumber = "{{Task.Param.Number}}";  // of the shard or merge of a task

// Open Job Description requires default paths to be relative.
std::string relative_to(const std::string& folder, const std::string& path) {
  std::error_code error;
  const auto relative = std::filesystem::relative(path, folder, error);
  return error ? path : relative.string();
}

// Job names have a limited length, and "{{" in them would begin a variable.
std::string job_name(const Plan& plan) {
  constexpr size_t kMaxLength = 128;
  const std::string name = "svdag " + plan.steps.back().output;
  return name.size() > kMaxLength || name.find("{{") != std::string::npos ? "svdag" : name;
}

// Steps of the plan that may run concurrently: a step of the template with a task for each.
struct Stage {
  std::string name;
  std::vector<size_t> steps;
};

// The shards, then the merges by their height above the shards, then the colours.
std::vector<Stage> stages_of(const Plan& plan) {
  std::vector<size_t> height;
  std::map<size_t, Stage> stages;
  for (size_t i = 0; i < plan.steps.size(); ++i) {
    size_t own = 0;
    for (const size_t input : plan.steps[i].inputs) own = std::max(own, height[input] + 1);
    height.push_back(own);
    Stage& stage = stages[own];
    stage.name = own == 0                     ? "Shards"
                 : plan.steps[i].is_colours() ? "Colours"
                                              : "Merges" + std::to_string(own);
    stage.steps.push_back(i);
  }
  std::vector<Stage> list;
  for (auto& [own, stage] : stages) list.push_back(std::move(stage));
  return list;
}

Json requirements(const Plan& plan, const Stage& stage) {
  uint64_t memory = 0, threads = 1;
  for (const size_t i : stage.steps) {
    memory = std::max(memory, plan.steps[i].predicted.memory);
    threads = std::max<uint64_t>(threads, plan.steps[i].threads);
  }
  return {{"amounts",
           Json::array({{{"name", "amount.worker.memory"}, {"min", (memory + (1 << 20) - 1) >> 20}},
                        {{"name", "amount.worker.vcpu"}, {"min", threads}}})}};
}

Json step_json(const Plan& plan, const SubmitConfig& config, const Stage& stage) {
  const PlanStep& first = plan.steps[stage.steps.front()];
  const std::string tasks = first.is_colours() ? "1"
                                               : number_in(first.name) + "-" +
                                                     number_in(plan.steps[stage.steps.back()].name);
  double seconds = 0;
  for (const size_t i : stage.steps) seconds = std::max(seconds, plan.steps[i].predicted.seconds);
  Json arguments = {"run", "{{Param.Plan}}", "--step",
                    first.is_shard()     ? shard_name(kNumber)
                    : first.is_colours() ? kColoursName
                                         : merge_name(kNumber)};
  if (!config.scratch.empty()) arguments.push_back("--scratch={{Param.Scratch}}");
  if (config.keep && first.name == plan.steps.back().name) arguments.push_back("--keep");
  return {{"name", stage.name},
          {"parameterSpace",
           {{"taskParameterDefinitions",
             Json::array({{{"name", "Number"}, {"type", "INT"}, {"range", tasks}}})}}},
          {"hostRequirements", requirements(plan, stage)},
          {"script",
           {{"actions",
             {{"onRun",
               {{"command", "{{Param.Svdag}}"},
                {"args", arguments},
                {"timeout", std::max(kMinTimeout, int(kTimeMargin * seconds))}}}}}}}};
}

}  // namespace

std::string openjd_template(const Plan& plan, const SubmitConfig& options) {
  SubmitConfig config = options;  // with absolute paths, since hosts run in other folders
  config.program = program_on_hosts(options.program);
  if (config.template_path.empty()) config.template_path = plan.path("openjd.json");
  if (!options.scratch.empty()) config.scratch = absolute_unresolved(options.scratch);
  for (const std::string& path :
       {plan.folder, config.template_path, config.program, config.scratch})
    require_utf8(path);
  Json json = {{"specificationVersion", "jobtemplate-2023-09"}, {"name", job_name(plan)}};
  json["parameterDefinitions"] =
      Json::array({{{"name", "Plan"},
                    {"type", "PATH"},
                    {"objectType", "DIRECTORY"},
                    {"dataFlow", "INOUT"},
                    {"description", "The folder that svdag plan wrote"},
                    {"default", relative_to(folder_of(config.template_path), plan.folder)}},
                   {{"name", "Svdag"},
                    {"type", "STRING"},
                    {"description", "The program svdag on the hosts"},
                    {"default", config.program}}});
  if (!config.scratch.empty())
    json["parameterDefinitions"].push_back(
        {{"name", "Scratch"},
         {"type", "STRING"},
         {"description", "The folder on the hosts for what does not fit in memory"},
         {"default", config.scratch}});
  std::string before;
  for (const Stage& stage : stages_of(plan)) {
    Json step = step_json(plan, config, stage);
    if (!before.empty()) step["dependencies"] = Json::array({{{"dependsOn", before}}});
    json["steps"].push_back(step);
    before = stage.name;
  }
  return json.dump(1) + "\n";
}

void submit_openjd(const Plan& plan, const SubmitConfig& config) {
  const std::string path =
      config.template_path.empty() ? plan.path("openjd.json") : config.template_path;
  AtomicFile file(path);
  file.append(openjd_template(plan, config));
  file.commit();
  if (!config.quiet) std::printf("%s\n", printable(path).c_str());
}

}  // namespace svdag
