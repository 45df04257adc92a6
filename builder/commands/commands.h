// The sub-commands of `svdag`: each a Config that main.cpp fills from the command line, and a
// run().
#pragma once

#include <string>
#include <vector>

#include "builder/build.h"
#include "builder/merge_runs.h"

namespace svdag {

// What every sub-command understands.
struct OutputConfig {
  bool quiet = false;    // -q: errors only
  bool verbose = false;  // -v: seconds and memory per phase
  Progress::Mode progress = Progress::Mode::kAuto;
};

struct BuildCommandConfig {
  BuildConfig build;
  size_t threads = 0;  // 0: all processors
  std::string report;  // --report: where the JSON report goes, "" for nowhere
  OutputConfig output;
};

struct MergeCommandConfig {
  MergeRunsConfig merge;
  size_t threads = 0;  // 0: all processors
  OutputConfig output;
};

struct InfoConfig {
  std::vector<std::string> paths;  // one .svdag, or the files of one scene
  bool json = false;
  bool levels = false;  // a table of levels
  NameFilter names;     // for scenes
  bool skip_invalid = false;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine
};

// Each returns the exit code and throws Error for everything that went wrong.
int run_build(const BuildCommandConfig& config);
int run_merge(const MergeCommandConfig& config);
int run_info(const InfoConfig& config);

// The part of run_info that looks at scenes.
void info_scene(const InfoConfig& config);

}  // namespace svdag
