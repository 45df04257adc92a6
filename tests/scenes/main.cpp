// svdag-scene: makes test scenes of any size. In the bundle, in no package.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/program.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/ply_writer.h"

namespace {

using namespace svdag;

struct Config {
  std::string kind;
  std::string triangles;
  std::string output;
  scenes::PlyOptions ply;
  bool quiet = false;
};

// Decimal counts here, unlike in the programs: "10M" means ten million triangles.
uint64_t parse_triangles(const std::string& text) {
  if (text.empty()) return 0;  // not given
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(text.c_str(), &end);
  const std::string suffix = end;
  const double unit = suffix == "" ? 1 : suffix == "K" ? 1e3 : suffix == "M" ? 1e6 : 0;
  if (end == text.c_str() || unit == 0 || !(value * unit >= 1 && value * unit <= 1e12))
    fail_usage("--triangles: \"" + text + "\" is not a number like 5000, 260K or 10M");
  return uint64_t(value * unit);
}

void run(const Config& config) {
  if (!(std::abs(config.ply.yaw) <= 360)) fail_usage("--yaw: give -360 to 360 degrees");
  const auto mesh =
      scenes::make_scene(config.kind, parse_triangles(config.triangles), config.ply.seed);
  scenes::write_ply(*mesh, config.ply, config.output);
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
  takes_files(app.add_option("-o,--output", config.output, "the PLY file to write"), {".ply"})
      ->required()
      ->type_name("X.ply");
  app.set_version_flag("-V,--version", "svdag-scene " SVDAG_VERSION, "print the version and exit");
  add_examples(&app, {"svdag-scene city -n 1M --yaw 30 -o city.ply"});
}

int parse_and_run(int argc, char** argv) {
  Config config;
  CLI::App app("Makes a test scene as a binary PLY file, the same bytes on every machine",
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
