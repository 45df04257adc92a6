// A bake: scene files in, one `.svdag` out, or a `.run` of all or a part of the grid.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "builder/cache/cell_store.h"
#include "builder/colours/colour_pass.h"
#include "builder/descend/descend.h"
#include "builder/octree/grid_part.h"
#include "builder/overlap/overlap.h"
#include "builder/split/split.h"
#include "io/dag/format.h"
#include "io/dag/layers/layer_palette.h"
#include "streaming/file/file.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

// What to do with an unfinished bake of the same output. If it is another bake or damaged, kResume
// rejects it and kResumeSame discards it.
enum class Unfinished { kRefuse, kResume, kResumeSame, kRestart };

// The finished split of a plan (builder/farm/plan/plan.h): bins of spilled triangles.
struct ReadySplit {
  std::string description;  // of the bake
  Grid grid;
  SplitCounts counts;
  std::vector<TriangleBin> bins;   // every bin that meets the grid part to bake
  SpillFile* triangles = nullptr;  // holds the streams of `bins`
  SceneLayers layers = {};
  std::shared_ptr<const CellWindings> windings = {};  // null unless the rule is solid
  CutOuts cut_outs = {};
};

// Default of --checkpoint, in seconds.
constexpr double kCheckpointSeconds = 30;

struct BuildConfig : ContentOptions {
  SceneConfig scene;
  const ReadySplit* ready = nullptr;  // replaces `scene` and the grid options
  std::string output;                 // path; `.run` writes a run file, any other name a `.svdag`
  std::optional<CellRange> part;      // bakes only these cells; the output is a `.run`
  std::optional<ColourPassConfig> colours;  // --colours: a pass adds them to the baked file
  LayerPalette palette;                     // --palette: the colours of layers
  FastPaths fast_paths;                     // for measurements and tests
  uint64_t memory = 0;                      // --memory in bytes; 0: half of the machine
  int cell_level = -1;                      // octree level of the cells; -1: chosen by the grid
  std::string scratch;  // --scratch: parent of the scratch folder; empty: the output's folder
  Unfinished unfinished = Unfinished::kRefuse;  // --resume, --restart
  bool hash_files = false;  // --report: read the scene's files a second time to hash them
  double checkpoint = kCheckpointSeconds;  // max seconds of work that a killed bake loses
  // --cache: opens the store of cached cells; empty: no cache.
  std::function<std::unique_ptr<CellStore>(const Grid&, Rule, MemoryBudget*)> open_store;
};

// A file of the scene; the buffers of a glTF file are files of the scene too.
struct SceneFile {
  std::string path;
  uint64_t bytes = 0;
  std::string hash;  // XXH3-128 of the content, 32 hex digits

  std::string name() const { return base_name(path); }
};

// The description_hash of the report that this bake would give. Reads all files of the scene.
std::string description_hash_of(const BuildConfig& config);

// Error (kUsage) if the file of the bake cannot have the colours that it is to have.
void check_colours(const BuildConfig& config);

// What a phase took.
struct PhaseUse {
  double seconds = 0;
  uint64_t peak = 0;  // bytes, counted by the memory budget
};

// What a colour pass made. `header`: of the file with the colours.
struct ColourReport : ColourPassReport {
  Header header{};
  bool resumed = false;
  double seconds = 0;
  uint64_t scratch = 0;  // peak in bytes, of a pass over a file
};

struct BuildReport {
  // If BuildConfig::hash_files is set.
  std::vector<SceneFile> files;
  std::string description_hash;  // 32 hex digits; equal for bakes with the same inputs and options
  std::optional<Box> scene_bounds;  // unless --bounds or --cube replaces them
  Grid grid;
  int cell_level = 0;
  Rule rule = Rule::kConservative;
  SplitCounts split;
  uint64_t cells = 0;  // visited
  DescentCounts descent;
  CellStoreCounts cache;
  uint64_t runs = 0;  // merged, including those of interrupted processes
  bool resumed = false;
  uint64_t voxels_kept = 0;     // of `voxels`, those baked before this process resumed
  uint64_t voxels = 0;          // of the union
  LayerTable layers;            // without roots
  std::vector<uint64_t> nodes;  // per level, unique; the last entry counts bricks
  uint64_t file_bytes = 0;
  std::string content_hash;  // 32 hex digits, as `svdag info` prints it
  std::optional<ColourReport> colours;
  size_t threads = 0;
  struct Phases {
    PhaseUse bounds, split, voxelize, sort, merge, write;
  } phases;
  double seconds = 0;
  double cpu_seconds = 0;  // of all threads of the process
  struct ScratchBytes {
    uint64_t estimated = 0, peak = 0, written = 0, read = 0;
  } scratch;                   // of this process only
  uint64_t peak_counted = 0;   // bytes, counted by the memory budget
  uint64_t peak_resident = 0;  // bytes, reported by the kernel
};

// Bakes the scene. Throws Error; the output path then still names the old file, or the complete new
// one if only the final sync or the clean-up failed.
BuildReport build(const BuildConfig& config, Executor* executor, Progress* progress);

}  // namespace svdag
