#include "builder/farm/engines/farm_engine.h"

#include "streaming/error.h"

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

}  // namespace svdag
