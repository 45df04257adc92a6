// The commands of `svdag-verify`: one struct each, and run(), which executes it and returns the
// exit code. The command line is parsed to a VerifyCommand (verify/commands/options.h); main()
// visits it.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/dag/graph/selection.h"
#include "io/scene/scene.h"
#include "io/units.h"
#include "verify/commands/common.h"
#include "verify/trace/view_options.h"

namespace svdag {

// svdag-verify check FILE: tests all checksums and pointers, order, minimality, counts, metadata.
struct CheckConfig {
  CommonConfig common;
  std::string file;
};

// Returns kOk, or kDiffers if the file is intact but not the canonical minimal DAG. Error: damage.
int run(const CheckConfig& config);

// svdag-verify mesh FILE SCENE...: voxelizes the scene again and compares all voxels.
struct MeshConfig {
  CommonConfig common;
  std::string file;
  SceneConfig scene;
  std::string judge = "integer";   // or "cgal", "openvdb"
  std::optional<uint64_t> sample;  // number of bricks to draw; none: compare all
  uint64_t seed = 1;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine's
};

// Returns kOk, or kDiffers if a voxel is missing or extra, or the grid does not match the scene.
// Error: kUsage if a sample drew nothing although the scene may have voxels.
int run(const MeshConfig& config);

// The same with OpenVDB, which gives two bounds instead of an exact set
// (verify/compare/distance_bounds.h).
int run_distance_bounds(const MeshConfig& config, const DagFile& file);

// svdag-verify colours FILE SCENE...: computes colours of the scene again, and compares.
struct ColoursConfig {
  CommonConfig common;
  std::string file;
  SceneConfig scene;
  uint64_t sample = 10'000;  // number of cubes to draw
  uint64_t seed = 1;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine's
};

// Returns kOk, or kDiffers if a colour is wrong, or the grid does not match the scene. Error:
// kBadInput if drawn cubes have no triangle, kUsage if the file has no colours.
int run(const ColoursConfig& config);

// svdag-verify diff A B: counts and lists the voxels that only one of two DAGs has.
struct DiffConfig {
  CommonConfig common;
  std::string a, b;
  Selection selection;     // of both
  uint64_t show = 10;      // differing voxels to list
  bool by_index = false;   // compare by voxel index, ignoring positions
  std::string write_diff;  // output: a PLY of the centres of differing voxels; empty: none
  std::string render;      // output: a PNG; empty: none
  PictureSize size;        // of the PNG
  uint64_t write_most = 10'000'000;  // limit of its points
};

// Returns kOk if both have the same voxels, else kDiffers.
int run(const DiffConfig& config);

// svdag-verify vdb FILE GRID.vdb: compares every voxel with an OpenVDB grid.
struct VdbConfig {
  CommonConfig common;
  std::string file, vdb;
  std::string grid;                  // name of the grid; empty: the only one
  std::optional<ValueRange> iso;     // values of a float grid that count as set
  bool sandbox = false;              // OpenVDB runs in a process that can only compute
  std::optional<Box> bounds;         // compare only this part
  uint64_t show = 10;                // differing voxels to list, of each kind
  std::string write_diff;            // output: a .vdb with grids missing and extra; empty: none
  uint64_t write_most = 10'000'000;  // limit of the voxels of the grid extra
};

// Returns kOk if both have the same voxels, else kDiffers.
int run(const VdbConfig& config);

// svdag-verify trace FILE SCENE...: compares rays through the DAG with rays through the triangles.
struct TraceConfig {
  CommonConfig common;
  std::string file;
  SceneConfig scene;
  uint64_t rays = 1'000'000;
  uint64_t seed = 1;
  uint64_t memory = 0;  // budget in bytes; 0: half of the machine's
};

// Returns kOk, or kDiffers if a claim of verify/trace/judge/ray_judge.h is violated, or the grid
// does not match the scene. Error: kUsage if nothing was judged although the scene may have voxels.
int run(const TraceConfig& config);

// svdag-verify render FILE -o X.png: makes a picture of the voxels by tracing rays through the DAG.
struct RenderCommandConfig {
  CommonConfig common;
  std::string file;
  std::string output;
  std::string mode;     // a ShadeMode; empty: colour, or primary without layers
  Selection selection;  // without a level
  ViewOptions view;     // without --light: over the left shoulder; --reach: a twentieth of
                        // the scene's diagonal; --cone: 9 for ao, 0 for soft
  int supersample = 2;
  std::optional<uint64_t> level;  // cubes of this level are solid; none: voxels
  std::optional<Box> clip;        // only voxels in this box are shown, in scene units
  std::string slice;              // "z=1.5": only voxels behind this plane, and the layer in it
  bool grid_lines = false;        // draw the edges of voxels that are several pixels large
  std::optional<int> fly;         // number of frames of a full turn; none: one picture
  bool frames = false;            // a picture of each layer, in the order of the table
};

int run(const RenderCommandConfig& config);

// svdag-verify report FILE [JSON...] -o R.html: makes a page about a .svdag: pictures, levels, the
// report of its bake and the verdicts of other commands, where their JSON is given.
struct ReportConfig {
  CommonConfig common;
  std::string file;
  std::vector<std::string> inputs;  // JSON of svdag build --report, and of svdag-verify --json
  std::string output;
  int up = 1;                  // axis
  PictureSize size{960, 540};  // of a picture
};

// Returns kOk, or kDiffers if the file is not sound or a verdict is not ok; writes the page in both
// cases.
int run(const ReportConfig& config);

// svdag-verify view FILE: shows a page in the browser that flies through the voxels; with --to,
// writes it as a folder for any web server.
struct ViewConfig {
  CommonConfig common;
  std::string file;
  Selection selection;            // without a level
  int up = 1;                     // axis
  std::optional<uint64_t> level;  // the finest that is shown; none: voxels
  std::optional<std::string> to;  // write this folder instead of serving
  std::string at;                 // address to serve at: PORT or PORT/TOKEN
  bool keep = false;              // serve until Ctrl-C, also without an open page
  bool open = true;               // open the page in the browser
};

int run(const ViewConfig& config);

using VerifyCommand = std::variant<CheckConfig, MeshConfig, ColoursConfig, DiffConfig, VdbConfig,
                                   TraceConfig, RenderCommandConfig, ReportConfig, ViewConfig>;

}  // namespace svdag
