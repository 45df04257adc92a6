// The command line of svdag-trace.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/trace/program/device.h"

namespace svdag {

struct TraceOptions {
  std::string file;
  std::string device = "cpu";  // cpu, cuda
  std::string preset = "iso";
  std::vector<double> camera;  // px,py,pz,tx,ty,tz[,fov] in the world; empty: the preset
  std::vector<double> light;   // x,y,z[,radius] in the world; empty: above what is seen
  int up = 1;
  uint32_t width = 1280, height = 720;
  uint32_t samples = 64, rounds = 3;
  unsigned threads = 0;
  double reach = 0;  // of ambient occlusion, in world units; 0: no limit
  double cone = 0;   // half the angle of its rays' cones, in degrees; 0: exact
  bool beams = true;
  bool compare = false;       // trace on both, and compare
  std::string dump, picture;  // files to write; empty: none
};

// Nothing if the command line is complete without tracing (--help, --version). Error: kUsage.
std::optional<TraceOptions> parse_trace_options(int argc, char** argv);

// The rays of the options, in voxels of the file. Error (kUsage) if they are impossible.
Workload make_workload(const TraceOptions& options, const PlainFile& file);

}  // namespace svdag
