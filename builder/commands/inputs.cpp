#include "builder/commands/inputs.h"

#include "builder/farm/plan/plan_folder.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

void read_buffers(const SceneConfig& scene, uint64_t memory, CommandFiles* files) {
  MemoryBudget budget(memory_or_default(memory));
  Scene(scene, &budget).visit_files([&](const File& file) { files->read(file.path()); });
}

void read_plan(const Plan& plan, const PlanStep* own, CommandFiles* files) {
  for (const std::string& file : files_of(plan)) {
    if (own == nullptr || file != plan.path(own->output)) files->read(file);
  }
  for (const PlanInput& input : plan.inputs) files->read(input.path);
}

}  // namespace svdag
