// Options and output that several commands share.
#pragma once

#include <cstdint>
#include <string>

#include "io/grid.h"
#include "io/verdict.h"
#include "streaming/process/lap_timer.h"
#include "streaming/process/progress.h"

namespace svdag {

struct CommonConfig {
  bool quiet = false;    // print errors only
  bool verbose = false;  // print seconds and memory on stderr
  bool json = false;     // print results as one JSON object
  Progress::Mode progress = Progress::Mode::kAuto;
  uint64_t threads = 0;  // 0: one per processor
};

// Prints seconds and peak memory on stderr when destroyed, if enabled.
class Stopwatch {
 public:
  explicit Stopwatch(const CommonConfig& config) : enabled_(config.verbose && !config.quiet) {}
  ~Stopwatch();

 private:
  bool enabled_;
  LapTimer timer_;
};

// The verdict of `command` about `file`, which it names.
class DagFile;
Verdict begin_verdict(const char* command, const DagFile& file);

// Prints the verdict, as text or as JSON. Returns the exit code: kOk if `ok`, else kDiffers.
int finish(const CommonConfig& config, const Verdict& verdict, bool ok);

// A voxel with its centre in the world: "voxel (1, 2, 3) at (0.5, 1, 1.5)".
FigureValue voxel_value(const Grid& grid, const LatticePoint& voxel);

// The line "78 layers agree", for layers that text does not list; nothing for 0.
void add_agreeing_layers(Verdict* verdict, int64_t count);

// "1K^3 box, voxel size 0.5, corner (0, 0, 0), rule conservative".
std::string describe_grid(const DagFile& file);

}  // namespace svdag
