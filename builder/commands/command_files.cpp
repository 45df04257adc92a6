#include "builder/commands/command_files.h"

#include "streaming/error.h"
#include "streaming/memory_budget.h"

namespace svdag {

void CommandFiles::read(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) read(path);
}

void CommandFiles::read_buffers(const SceneConfig& scene, uint64_t memory) {
  MemoryBudget budget(memory != 0 ? memory : default_memory_limit());
  Scene(scene, &budget).visit_files([&](const File& file) { read(file.path()); });
}

void CommandFiles::write(const std::string& path) {
  if (inputs_.find(path) != nullptr)
    fail_usage(path + " is also an input, which is never overwritten: choose another output");
  if (outputs_.find(path) != nullptr)
    fail_usage(path + " would be written twice: choose another name for one of the results");
  outputs_.add(path);
}

}  // namespace svdag
