#include "builder/commands/command_files.h"

#include "builder/farm/plan/plan_folder.h"
#include "streaming/error.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

void CommandFiles::read(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) read(path);
}

void CommandFiles::read_buffers(const SceneConfig& scene, uint64_t memory) {
  MemoryBudget budget(memory_or_default(memory));
  Scene(scene, &budget).visit_files([&](const File& file) { read(file.path()); });
}

void CommandFiles::read(const Plan& plan, const PlanStep* own) {
  for (const std::string& file : files_of(plan)) {
    if (own == nullptr || file != plan.path(own->output)) read(file);
  }
  for (const PlanInput& input : plan.inputs) read(input.path);
}

void CommandFiles::write(const std::string& path) {
  if (inputs_.find(path) != nullptr)
    fail_usage(path + " is also an input, which is never overwritten: choose another output");
  if (!outputs_.insert(directory_entry_key(path)).second)
    fail_usage(path + " would be written twice: choose another name for one of the results");
}

}  // namespace svdag
