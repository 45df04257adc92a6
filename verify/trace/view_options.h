// The options of pictures: size, camera, light and rays, parsed once for svdag-verify and
// svdag-trace. Lengths are in scene units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verify/trace/kernel/workload.h"

namespace CLI {
class App;
}

namespace svdag {

struct PictureSize {
  int width = 1280, height = 720;
  double aspect() const { return double(width) / height; }
};

struct ViewOptions {
  PictureSize size;
  std::string preset = "iso";       // of preset_camera
  std::vector<double> camera;       // px,py,pz,tx,ty,tz[,fov]; empty: the preset
  int up = 1;                       // axis
  std::vector<double> light;        // x,y,z[,radius]; empty: the program's
  std::optional<uint32_t> samples;  // rays to the light, and to the sky; none: the program's
  double reach = 0;                 // length of ambient occlusion rays; 0: the program's
  std::optional<double> cone;  // half the angle of the rays' cones, in degrees; 0: exact; none: the
                               // program's
};

// The defaults of --light, --samples, --reach and --cone in the help.
struct RayDefaults {
  std::string light, samples, reach, cone;
};

// --size. `pixels`: "Pixels of a picture".
void add_size(CLI::App* app, PictureSize* size, const std::string& pixels = "Pixels");
// --up, an axis of the scene as it was baked.
void add_up(CLI::App* app, int* up);
// --size, --camera, --preset and --up.
void add_camera(CLI::App* app, ViewOptions* view);
// --light, --samples, --reach and --cone.
void add_rays(CLI::App* app, ViewOptions* view, const RayDefaults& defaults);

// The camera of --camera, or of --preset to show `box`. Error: kUsage.
Camera camera_of(const ViewOptions& view, const DagView& dag, const VoxelBounds& box);
// Replaces *light by that of --light, if it was given. Error: kUsage.
void apply_light(const ViewOptions& view, const DagView& dag, Light* light);
// Applies --samples, --reach and --cone if they were given.
void apply_rays(const ViewOptions& view, const DagView& dag, Secondary* secondary);
// The spread of rays in a cone of half the angle `degrees`.
double cone_spread(double degrees);

// Error (kUsage) with `sentence` if `name` has the ending of a picture format other than `written`
// (".png"), in upper or lower case.
void reject_other_picture_format(const std::string& name, const std::string& written,
                                 const std::string& sentence);

}  // namespace svdag
