// The commands of `svdag`: one struct each, and run(), which executes it.
//
// The command line is parsed to a Command (builder/commands/options.h); main() visits it.
#pragma once

#include <limits>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "builder/build.h"
#include "builder/cache/cell_cache.h"
#include "builder/colour_file.h"
#include "builder/edit/edit.h"
#include "builder/farm/engines/farm_engine.h"
#include "builder/farm/engines/run_step.h"
#include "builder/farm/planner/make_plan.h"
#include "builder/merge/merge_runs.h"
#include "io/dag/graph/selection.h"
#include "io/dag/pack/pack.h"
#include "io/help/manual.h"

namespace svdag {

struct OutputConfig {
  bool quiet = false;       // -q: print errors only
  bool verbose = false;     // -v: print details (seconds per phase, memory)
  bool json = false;        // --json: print the report instead of the summary
  bool no_clobber = false;  // -n: an existing output is an error; in a batch, it is skipped
  Progress::Mode progress = Progress::Mode::kAuto;

  Progress::Mode mode() const { return quiet ? Progress::Mode::kOff : progress; }
};

// Reports on stderr that an output has no colours although the file at `path` has.
void report_dropped_colours(const std::string& path);

// svdag build SCENE -o OUT: one bake.
struct BakeCommand {
  BuildConfig build;
  CellCacheConfig cache;  // --cache, --cache-size; no folder: no cache
  size_t threads = 0;     // 0: all processors
  std::string report;     // --report: path of the JSON report; empty: none
  OutputConfig output;
};

// svdag build SCENE --dry-run: predicts the bake.
struct DryRunCommand {
  BuildConfig build;
  size_t threads = 0;  // 0: all processors
  OutputConfig output;
};

// svdag batch LIST: the bakes of a list.
struct BatchCommand {
  std::string list;             // path of the JSON file
  BakeCommand defaults;         // options of bakes that do not override them
  std::set<std::string> flags;  // given on the command line, such as "skip-invalid"
  bool keep_going = false;      // continue after a bake that fails
  bool dry_run = false;
  std::string report;   // path of the JSON report of all bakes; empty: none
  size_t parallel = 1;  // max number of bakes at once
  bool json = false;    // print the report of all bakes instead of the summaries
};

// svdag merge RUN... -o OUT.
struct MergeCommand {
  MergeRunsConfig merge;
  size_t threads = 0;  // 0: all processors
  OutputConfig output;
};

// svdag plan SCENE -o PLAN.
struct PlanCommand {
  PlanConfig plan;
  OutputConfig output;
};

// svdag run PLAN.
struct RunCommand {
  std::string plan;
  size_t processes = 0;  // 0: one per processor
  std::string scratch;
  bool keep = false;  // --keep: the runs
  OutputConfig output;
};

// svdag run PLAN --step NAME: one step of a plan.
struct StepCommand {
  std::string plan;
  std::string name;  // of the step
  StepConfig step;
  size_t threads = 0;  // 0: as planned
  OutputConfig output;
};

// svdag submit PLAN.
struct SubmitCommand {
  std::string plan;
  const FarmEngine* engine = nullptr;
  SubmitConfig config;
};

// svdag info FILE.
struct InfoCommand {
  SceneConfig scene;  // its paths: one .svdag, .run or plan, or the files of a scene
  bool json = false;
  bool levels = false;  // print a table of levels, or of the steps of a plan
  bool layers = false;  // print a table of the layers of a .svdag
  bool parts = false;   // print the parts of a scene: objects, materials and files
  uint64_t memory = 0;  // bytes; 0: half of the machine
};

// svdag query FILE < POINTS.
struct QueryCommand {
  std::string file;
  bool nearest = false;  // find the nearest voxel instead of that at the point
  double max_distance = std::numeric_limits<double>::infinity();  // of it, in world units
};

// svdag edit A [B].
struct EditCommand {
  EditConfig edit;
  size_t threads = 0;  // 0: all processors
  OutputConfig output;
};

// svdag colour FILE SCENE -o OUT.
struct ColourCommand {
  ColourFileConfig colours;
  size_t threads = 0;  // 0: all processors
  OutputConfig output;
};

// svdag convert A.svdag -o B.svdag.
struct ConvertCommand {
  std::string file;
  std::string output_path;
  Selection selection;
  bool keeps_layout = false;  // that of the file instead of the selection's
  uint64_t memory = 0;        // bytes; 0: half of the machine
  std::string scratch;        // folder for data that does not fit in memory; empty: the output's
  OutputConfig output;
};

// svdag pack FILE -o OUT.pack.
struct PackCommand {
  std::string file;
  std::string output_path;
  Selection selection;
  int level = kDefaultPackLevel;  // of zstd
  uint64_t memory = 0;            // bytes; 0: half of the machine
  size_t threads = 0;             // 0: all processors
  OutputConfig output;
};

// svdag unpack FILE.pack -o OUT.svdag.
struct UnpackCommand {
  std::string file;
  std::string output_path;
  uint64_t memory = 0;  // bytes; 0: half of the machine
  size_t threads = 0;   // 0: all processors
  OutputConfig output;
};

// svdag help [SUBJECT]: the help of a command or topic.
struct HelpCommand {
  Manual program;
  std::string subject;  // a command or a topic; empty: the program
};

using Command =
    std::variant<HelpCommand, BakeCommand, DryRunCommand, BatchCommand, MergeCommand, PlanCommand,
                 RunCommand, StepCommand, SubmitCommand, InfoCommand, QueryCommand, EditCommand,
                 ColourCommand, ConvertCommand, PackCommand, UnpackCommand>;

// Each returns the exit code and throws Error for everything that fails.
int run(const HelpCommand& command);
int run(const BakeCommand& command);
int run(const DryRunCommand& command);
int run(const BatchCommand& command);
int run(const MergeCommand& command);
int run(const PlanCommand& command);
int run(const RunCommand& command);
int run(const StepCommand& command);
int run(const SubmitCommand& command);
int run(const InfoCommand& command);
int run(const QueryCommand& command);
int run(const EditCommand& command);
int run(const ColourCommand& command);
int run(const ConvertCommand& command);
int run(const PackCommand& command);
int run(const UnpackCommand& command);

// Bakes one scene. Returns its JSON report if in a batch or if --report is given, else "".
std::string bake_scene(const BakeCommand& command, bool in_a_batch);
// Prints a prediction of one bake, and returns it.
Prediction predict(const DryRunCommand& command);
// The paths of the files that a bake writes; Error (kUsage) if the output's path is empty.
std::vector<std::string> outputs_of(const BakeCommand& command);
// The bakes of a list, parsed; none is started.
std::vector<BakeCommand> bakes_of(const BatchCommand& batch);
// Error (kUsage) if a path is a plan, not a scene or run.
void reject_plans(const std::vector<std::string>& paths);
// `svdag info` for plans, runs and scenes.
void info_plan(const InfoCommand& command);
void info_run(const InfoCommand& command);
void info_scene(const InfoCommand& command);

}  // namespace svdag
