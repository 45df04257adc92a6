// The command `svdag export FILE -o OUT`: writes the voxels of a DAG in another format.
//
// Exports one level of a file, whole or within a box. It is a separate program, svdag-export, which
// `svdag export` starts, so that a bake does not load the libraries of other formats, which cost
// memory (OpenVDB 38 MB) and time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dag/graph/selection.h"
#include "io/formats/vdb.h"

namespace svdag {

struct ExportConfig {
  std::string file;
  std::string output;
  std::string format;  // a name in export_formats(); empty: from the output's extension
  Selection selection;
  std::optional<uint64_t> max_voxels;  // limit of formats that list voxels; none: 10^9
  std::optional<uint64_t> max_quads;   // limit of surfaces; none: 10^9
  std::optional<int> distance;         // --distance, npz: the largest distance, in voxels
  bool no_merge = false;               // --no-merge, surfaces: a quad for each face of a voxel
  std::optional<VdbFormat> vdb_type;   // --vdb-type; default: bool
  std::optional<int> up;               // --up, vox: the axis that is up, 0 to 2; default: y
  bool colours = false;                // --colours: hashdag gets a second file, of colours
  uint64_t memory = 0;                 // 0: half of the machine's memory
  bool no_clobber = false;             // -n: an existing output is an error
  bool quiet = false;
  bool json = false;  // print what was written as JSON
};

// One foreign format: its name, file extension and a description for the help text.
struct ExportFormat {
  const char* name;
  const char* ending;
  const char* description;
};

std::vector<ExportFormat> export_formats();

int run(const ExportConfig& config);

}  // namespace svdag
