// The command line of svdag-trace, and the workload that it selects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/trace/program/device.h"
#include "verify/trace/view_options.h"

namespace svdag {

struct TraceOptions {
  std::string file;
  std::string device = "cpu";  // cpu, cuda
  ViewOptions view;            // without --light: above the voxels; --reach unlimited; --cone exact
  uint32_t rounds = 3;
  unsigned threads = 0;  // 0: one per processor
  bool beams = true;
  bool gpu_tree = false;
  bool compare = false;             // trace on both devices, and compare
  bool json = false;                // print one line of JSON instead of a table
  std::vector<std::string> layers;  // at most one: trace only it
  std::string dump, picture;        // output files; empty: none
};

// Returns nothing if there is nothing to trace (--help, --version). Error: kUsage.
std::optional<TraceOptions> parse_trace_options(int argc, char** argv);

// The rays that the options describe, in voxels of the file. Error (kUsage) if values are out of
// range or the file has no voxel.
Workload make_workload(const TraceOptions& options, const PlainFile& file);

}  // namespace svdag
