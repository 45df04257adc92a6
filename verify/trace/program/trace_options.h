// The command line of svdag-trace, and the workload that it selects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/trace/program/device.h"

namespace svdag {

struct TraceOptions {
  std::string file;
  std::string device = "cpu";  // cpu, cuda
  std::string preset = "iso";  // of preset_camera
  std::vector<double> camera;  // px,py,pz,tx,ty,tz[,fov] in scene units; empty: the preset
  std::vector<double> light;   // x,y,z[,radius] in scene units; empty: above the voxels
  int up = 1;                  // axis
  uint32_t width = 1280, height = 720;
  uint32_t samples = 64, rounds = 3;
  unsigned threads = 0;  // 0: one per processor
  double reach = 0;      // length of ambient occlusion rays, in scene units; 0: unlimited
  double cone = 0;       // half the angle of their cones, in degrees; 0: exact
  bool beams = true;
  bool compare = false;              // trace on both devices, and compare
  bool json = false;                 // print one line of JSON instead of a table
  std::optional<std::string> layer;  // trace this one alone
  std::string dump, picture;         // output files; empty: none
};

// Returns nothing if there is nothing to trace (--help, --version). Error: kUsage.
std::optional<TraceOptions> parse_trace_options(int argc, char** argv);

// The rays that the options describe, in voxels of the file. Error (kUsage) if values are out of
// range or the file has no voxel.
Workload make_workload(const TraceOptions& options, const PlainFile& file);

}  // namespace svdag
