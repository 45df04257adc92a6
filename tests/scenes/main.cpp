// svdag-scene: makes test scenes of any size. In the bundle, in no package.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/program.h"
#include "tests/scenes/glb_writer.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/moving.h"
#include "tests/scenes/obj_writer.h"
#include "tests/scenes/ply_writer.h"

namespace {

using namespace svdag;

struct Config {
  std::string kind;
  std::string triangles;
  std::string output;
  scenes::PlyOptions ply;
  size_t frames = 0;   // of an animation; 0: a still scene
  bool tenth = false;  // only a tenth of the surface moves
  bool quiet = false;
};

// Decimal counts here, unlike in the programs: "10M" means ten million triangles.
uint64_t parse_triangles(const std::string& text) {
  if (text.empty()) return 0;  // not given
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(text.c_str(), &end);
  const std::string suffix = end;
  const std::map<std::string, double> units = {{"", 1}, {"K", 1e3}, {"M", 1e6}, {"G", 1e9}};
  const double unit = units.contains(suffix) ? units.at(suffix) : 0;
  if (end == text.c_str() || unit == 0 || !(value * unit >= 1 && value * unit <= 1e12))
    fail_usage("--triangles: \"" + text + "\" is not a number like 5000, 260K or 10M");
  return uint64_t(value * unit);
}

void write(const scenes::Mesh& mesh, const Config& config, const std::string& path) {
  const auto writer = path.ends_with(".glb")   ? scenes::write_glb
                      : path.ends_with(".obj") ? scenes::write_obj
                                               : scenes::write_ply;
  writer(mesh, config.ply, path);
}

// X_0001.ply, X_0002.ply, ...
void write_frames(const scenes::Mesh& mesh, const Config& config) {
  const size_t dot = config.output.find_last_of('.');
  for (uint64_t i = 0; i < config.frames; ++i) {
    char number[16];
    std::snprintf(number, sizeof number, "_%04d", int(i) + 1);
    const std::string path = config.output.substr(0, dot) + number +
                             config.output.substr(std::min(dot, config.output.size()));
    write(scenes::MovingMesh(mesh, i, config.frames,
                             config.tenth ? scenes::MovingPart::kTenth : scenes::MovingPart::kAll),
          config, path);
    if (!config.quiet) std::printf("%s: frame %d\n", path.c_str(), int(i) + 1);
  }
}

void run(const Config& config) {
  if (!(std::abs(config.ply.yaw) <= 360)) fail_usage("--yaw: give -360 to 360 degrees");
  const auto mesh =
      scenes::make_scene(config.kind, parse_triangles(config.triangles), config.ply.seed);
  if (config.frames > 0) return write_frames(*mesh, config);
  write(*mesh, config, config.output);
  if (!config.quiet)
    std::printf("%s: %s triangles, %s vertices\n", config.output.c_str(),
                format_count(mesh->faces()).c_str(), format_count(mesh->vertices()).c_str());
}

void declare(CLI::App& app, Config& config) {
  std::string names;
  for (const auto& kind : scenes::kinds())
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  app.add_option("kind", config.kind, names)->required();
  app.add_option("-n,--triangles", config.triangles,
                 "about how many: 5000, 260K, 10M (each kind has a default)")
      ->type_name("N");
  takes_whole_number(app.add_option("--seed", config.ply.seed, "another scene of the same kind"))
      ->type_name("N");
  app.add_option("--yaw", config.ply.yaw, "rotate about the y axis, in degrees")
      ->type_name("DEGREES");
  app.add_flag("--shuffle", config.ply.shuffle, "vertices and faces in random order");
  app.add_flag("--double", config.ply.double_precision, "64-bit coordinates");
  app.add_flag("-q,--quiet", config.quiet, "print nothing");
  CLI::Option* frames =
      from_to(app.add_option("--frames", config.frames,
                             "N frames of the scene swaying, as X_0001.ply, X_0002.ply, ..."),
              1, 9999)
          ->type_name("N");
  app.add_flag("--tenth", config.tenth, "only the top tenth of a scan's surface sways")
      ->needs(frames);
  takes_files(app.add_option("-o,--output", config.output,
                             "the file to write: .ply, .obj with names of the parts, or .glb with "
                             "textures (atrium) or a walk (figure)"),
              {".ply", ".obj", ".glb"})
      ->required()
      ->type_name("X.ply");
  app.set_version_flag("-V,--version", "svdag-scene " SVDAG_VERSION, "print the version and exit");
  add_examples(&app, {"svdag-scene city -n 1M --yaw 30 -o city.ply"});
}

int parse_and_run(int argc, char** argv) {
  Config config;
  CLI::App app("Makes a test scene as a PLY, OBJ or GLB file, the same bytes on every machine",
               "svdag-scene");
  declare(app, config);
  if (const auto exit_code = read_command_line(&app, argc, argv)) return *exit_code;
  run(config);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return run_program({.name = "svdag-scene"}, [argc, argv] { return parse_and_run(argc, argv); });
}
