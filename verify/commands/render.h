// svdag-verify render FILE -o X.png: makes a picture of the voxels by tracing rays through the DAG.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/triangle.h"
#include "verify/commands/common.h"
#include "verify/trace/cpu.h"

namespace svdag {

struct RenderCommandConfig {
  CommonConfig common;
  std::string file;
  std::string output;
  std::string mode;                 // a ShadeMode; empty: colour, or primary without layers
  std::vector<std::string> layers;  // only these
  std::string size = "1280x720";
  std::vector<double> camera;  // px,py,pz,tx,ty,tz[,fov] in scene units; empty: the preset
  std::string preset = "iso";  // of preset_camera
  std::string up = "y";
  int supersample = 2;
  std::vector<double> light;  // x,y,z[,radius] in scene units; empty: over the left shoulder
  uint64_t samples = 16;      // rays to the light or the sky for each camera ray
  double reach = 0;           // length of ambient occlusion rays, in scene units; 0: a twentieth of
                              // the scene's diagonal
  std::optional<double> cone;  // half the angle of the rays' cones, in degrees; 0: exact; none: 9
                               // for ao, 0 for soft
  std::optional<uint64_t> level;  // cubes of this level are solid; none: voxels
  std::optional<Box> clip;        // only voxels in this box are shown, in scene units
  std::string slice;              // "z=1.5": only voxels behind this plane, and the layer in it
  bool grid_lines = false;        // draw the edges of voxels that are several pixels large
  std::optional<int> fly;         // number of frames of a full turn; none: one picture
  bool frames = false;            // a picture of each layer, in the order of the table
};

int run(const RenderCommandConfig& config);

// The colours of a file's layers, for pictures.
class LayerColours {
 public:
  // `file` must outlive this. Without layers there is nothing to show.
  explicit LayerColours(const DagFile& file);
  // Shows them in a picture; this must outlive its rendering.
  void show_in(RenderConfig* picture) const;

 private:
  std::optional<LayerIndex> index_;
  std::vector<Vec3> albedos_;
};

// Parses "1280x720" into a RenderConfig. Error: kUsage.
RenderConfig parse_size(const std::string& size);

}  // namespace svdag
