// The command svdag export FILE -o X: writes the voxels of a DAG in another format.
//
// Exports a whole file at one of its levels, or a window of it. Runs as a program of its own,
// svdag-export, which `svdag export` starts: a bake does not load the libraries of other formats,
// which cost memory (OpenVDB 38 MB) and time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/triangle.h"

namespace svdag {

struct ExportConfig {
  std::string file;
  std::string output;
  std::string format;         // a name of export_formats(); empty: from the output's ending
  std::optional<int> level;   // the level whose nodes become voxels; none: L, the finest
  std::optional<Box> bounds;  // only the voxels whose interior meets this box
  std::optional<uint64_t> max_voxels;  // limit for formats that list voxels; none: 10^9
  bool as_bool = false;                // VDB grids of type bool, for readers without masks
  uint64_t memory = 0;                 // 0: half of the machine's memory
  bool quiet = false;
};

// One foreign format: its name, the ending of its files, and a description for people.
struct ExportFormat {
  const char* name;
  const char* ending;
  const char* description;
};

std::vector<ExportFormat> export_formats();

int run(const ExportConfig& config);

}  // namespace svdag
