// The command `svdag import FILE -o OUT.svdag`: converts voxels of other programs to a minimal
// canonical DAG.
//
// It is a separate program, svdag-import, which `svdag import` starts, so that a bake does not load
// the libraries of other formats. The format is detected from the content of the file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/import/import.h"
#include "io/units.h"

namespace svdag {

struct ImportCommandConfig {
  std::vector<std::string> files;    // several: of points
  std::string format;                // a name in import_formats(); empty: from the file's content
  std::string grid;                  // --grid, vdb: name of the grid; empty: the file's only grid
  std::optional<ValueRange> iso;     // --iso, vdb: values of a float grid that are set
  std::optional<double> voxel_size;  // --voxel-size, points; nothing: import.levels
  LayerKind layers = LayerKind::kNone;  // --layers, points: kMaterial of classes, or kFile
  std::optional<int> up;                // --up, vox: the axis that z becomes, 0 to 2; default: y
  bool no_layers = false;               // --no-layers: labels are ignored, and materials of a .vox
  bool no_colours = false;              // --no-colours: colours are ignored
  bool sandbox = false;  // --sandbox: OpenVDB runs in a process that can only compute
  ImportConfig import;
  size_t threads = 0;       // 0: all processors
  bool no_clobber = false;  // -n: an existing output is an error
  bool quiet = false;
  bool json = false;  // print counts and content hash as JSON
};

// The names of the supported formats.
std::vector<std::string> import_formats();

int run(const ImportCommandConfig& config);

}  // namespace svdag
