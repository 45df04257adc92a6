// The command line of svdag-trace, read without a library.
#pragma once

#include "io/help/manual.h"
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
  bool compare = false;                               // the processor's answers with the GPU's
  bool help = false, version = false, table = false;  // the last: kManualTable
  std::string dump, picture;                          // files to write, or empty
};

// Anything that cannot be meant is an Error (kUsage).
TraceOptions parse_trace_options(int argc, char** argv);

// The rays that the options ask for, on this file.
Workload make_workload(const TraceOptions& options, const PlainFile& file);

// What its options say.
Manual trace_manual();

}  // namespace svdag
