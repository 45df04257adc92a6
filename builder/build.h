// A bake: scene files in, one `.svdag` out, or a `.run` of all or a part of the grid.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "builder/cache/cell_store.h"
#include "builder/descend/descend.h"
#include "builder/octree/grid_part.h"
#include "builder/overlap/overlap.h"
#include "builder/split/split.h"
#include "io/dag/format.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

// What to do with an unfinished bake of the same output. If it is another bake or damaged, kResume
// rejects it and kResumeSame discards it.
enum class Unfinished { kRefuse, kResume, kResumeSame, kRestart };

// A split that was made before, by a plan (builder/farm/plan/plan.h).
struct ReadySplit {
  std::string description;  // of the bake
  Grid grid;
  SplitCounts counts;
  std::vector<TriangleBin> bins;   // all that the part needs
  SpillFile* triangles = nullptr;  // which holds them
};

// Default of --checkpoint, in seconds.
constexpr double kCheckpointSeconds = 30;

struct BuildConfig {
  SceneConfig scene;
  const ReadySplit* ready = nullptr;  // replaces the scene and the options of its grid
  std::string output;                 // a `.run` if it is named so, else a `.svdag`
  std::optional<CellRange> part;      // bake these cells only; the output is a `.run`
  int levels = 0;                     // -r: L of the grid; 0 if the voxel size is given instead
  double voxel_size = 0;              // --voxel-size, in world units; 0 if the resolution is given
  DescentConfig descent;              // --rule
  std::optional<Box> bounds;          // --bounds, in world units
  uint64_t memory = 0;                // --memory in bytes; 0: half of the machine
  int cell_level = -1;                // octree level of the cells; -1: chosen by the grid
  std::string scratch;  // --scratch: the folder for scratch folders; empty: the output's
  Unfinished unfinished = Unfinished::kRefuse;  // --resume, --restart
  bool name_files = false;  // --report: read the scene's files once more, for their hashes
  // --checkpoint: seconds of work that a killed bake may lose.
  double checkpoint = kCheckpointSeconds;
  // --cache: opens the store of cells baked before; empty: no cache.
  std::function<std::unique_ptr<CellStore>(const Grid&, Rule, MemoryBudget*)> open_store;
};

// A file of the scene, buffers of glTF included.
struct SceneFile {
  std::string path;
  uint64_t bytes = 0;
  std::string hash;  // XXH3-128 of its content, 32 hex digits

  std::string name() const { return path.substr(path.find_last_of('/') + 1); }
};

struct BuildReport {
  std::vector<SceneFile> files;  // if BuildConfig::name_files is set
  Grid grid;
  int cell_level = 0;
  Rule rule = Rule::kConservative;
  SplitCounts split;
  DecisionCounts decisions;
  PlaneMemoCounts memo;
  std::vector<uint64_t> divided;  // cubes per level that the descent divided, inside the cells
  uint64_t cells = 0;             // visited
  uint64_t runs = 0;              // merged; those of an earlier process included
  uint64_t cache_hits = 0;        // of the cells
  uint64_t cache_ignored = 0;     // packs of the cache that the memory had no room for
  std::string cache_complaint;    // why cells were not kept; empty if all were
  bool resumed = false;
  uint64_t voxels_kept = 0;  // of `voxels`, by the processes before this one
  uint64_t voxels = 0;
  std::vector<uint64_t> nodes;  // per level, unique; the last entry counts bricks
  uint64_t file_bytes = 0;
  std::string content_hash;  // 32 hex digits, as `svdag info` prints it
  size_t threads = 0;
  struct Seconds {
    double bounds = 0, split = 0, voxelize = 0, sort = 0, merge = 0, write = 0, total = 0;
    double cpu = 0;  // of all threads, whole process
  } seconds;
  struct PhaseBytes {
    uint64_t bounds = 0, split = 0, voxelize = 0, sort = 0, merge = 0, write = 0;
  } phase_peaks;  // by the memory budget
  struct ScratchBytes {
    uint64_t estimated = 0, peak = 0, written = 0, read = 0;
  } scratch;                   // of this process
  uint64_t peak_counted = 0;   // bytes, by the memory budget
  uint64_t peak_resident = 0;  // bytes, by the kernel
};

// Throws Error; the output is then the old file, or, if only the last sync or the clean-up failed,
// the complete new one.
BuildReport build(const BuildConfig& config, Executor* executor, Progress* progress);

}  // namespace svdag
