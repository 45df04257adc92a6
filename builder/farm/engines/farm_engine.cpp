#include "builder/farm/engines/farm_engine.h"

#include <filesystem>

#include "streaming/error.h"
#include "streaming/process/child_process.h"

namespace svdag {

const std::vector<FarmEngine> kFarmEngines = {
    {"slurm", "submits jobs", {"--wait", "OPTION"}, submit_slurm},
    {"openjd", "writes a template", {"--output"}, submit_openjd},
};

const FarmEngine& farm_engine(const std::string& name) {
  for (const FarmEngine& engine : kFarmEngines) {
    if (engine.name == name) return engine;
  }
  fail_usage("--engine: unknown engine \"" + name + "\"");
}

std::string absolute_unresolved(const std::string& path) {
  std::error_code error;
  const auto absolute = std::filesystem::absolute(path, error);
  return error ? path : absolute.string();
}

std::string program_on_hosts(const std::string& program) {
  if (program.empty()) return own_program();
  return program.find('/') == std::string::npos ? program : absolute_unresolved(program);
}

}  // namespace svdag
