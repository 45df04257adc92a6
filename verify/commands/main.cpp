// svdag-verify: the independent judge of what `svdag build` wrote.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "io/suggest.h"
#include "io/units.h"
#include "streaming/program.h"
#include "verify/commands/check.h"
#include "verify/commands/diff.h"
#include "verify/commands/mesh.h"
#include "verify/commands/render.h"
#include "verify/commands/report.h"
#include "verify/commands/trace.h"
#include "verify/commands/vdb.h"

namespace svdag {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 ok, 1 differs, 2 usage, 3 bad input, 4 disk or output, 5 memory.";

void add_common(CLI::App* command, CommonConfig* config, bool with_json) {
  command->add_flag("-q,--quiet", config->quiet, "Print nothing but errors");
  command->add_flag("-v,--verbose", config->verbose, "Also print seconds and memory");
  if (with_json) command->add_flag("--json", config->json, "Print the result as one JSON object");
  command->add_flag_callback(
      "--progress", [config] { config->progress = Progress::Mode::kOn; },
      "Show progress even if stderr is no terminal");
  command->add_flag_callback(
      "--no-progress", [config] { config->progress = Progress::Mode::kOff; },
      "Never show progress");
}

void add_threads(CLI::App* command, CommonConfig* config) {
  command->add_option("-j,--threads", config->threads, "Threads (default: all processors)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
}

void add_scene(CLI::App* command, SceneConfig* scene) {
  command->add_option("SCENE", scene->paths, "The scene files it was baked from")->required();
  command
      ->add_option("--include", scene->names.include,
                   "Only parts with a name that matches this pattern")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  command
      ->add_option("--exclude", scene->names.exclude,
                   "No parts with a name that matches this pattern")
      ->allow_extra_args(false)
      ->type_name("PATTERN");
  command->add_flag("--skip-invalid", scene->skip_invalid,
                    "Drop triangles with NaN or infinity, as in the bake");
}

// A number as people write it: "10M".
void add_count(CLI::App* command, const std::string& option, uint64_t* count, const char* text,
               const char* type = "N") {
  const std::string name = option.substr(option.find("--"));
  command
      ->add_option_function<std::string>(
          option,
          [name, count](const std::string& value) { *count = parse_count(value, name.c_str()); },
          text)
      ->type_name(type);
}

void add_memory(CLI::App* command, uint64_t* memory) {
  add_count(command, "-m,--memory", memory,
            "Memory budget of the readers and the triangles held (default: half of the machine)",
            "SIZE");
}

void add_check(CLI::App* app, int* result) {
  auto config = std::make_shared<CheckConfig>();
  CLI::App* command =
      app->add_subcommand("check", "Prove every checksum and pointer, order and minimality");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  add_common(command, &config->common, true);
  command->footer(std::string("Example: svdag-verify check scene.svdag\n") + kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_mesh(CLI::App* app, int* result) {
  auto config = std::make_shared<MeshConfig>();
  CLI::App* command = app->add_subcommand(
      "mesh", "Voxelize the scene again, by other means, and compare every voxel");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  add_scene(command, &config->scene);
  command
      ->add_option("--judge", config->judge,
                   "Who decides: integer (our exact clipping, the default), cgal (CGAL's exact "
                   "kernel; slow) or openvdb (two bounds by its distances)")
      ->check(CLI::IsMember({"integer", "cgal", "openvdb"}))
      ->type_name("JUDGE");
  add_count(command, "--sample", &config->sample,
            "Compare N drawn bricks instead of all, and bound the error rate (openvdb: N windows "
            "of 512^3 voxels around such bricks)");
  command->add_option("--seed", config->seed, "Seed of the drawing (default 1)")->type_name("N");
  add_memory(command, &config->memory);
  add_threads(command, &config->common);
  add_common(command, &config->common, true);
  command->footer(
      std::string("Examples: svdag-verify mesh sponza.svdag sponza.glb\n"
                  "          svdag-verify mesh --sample 100000 city.svdag city.ply --json\n") +
      kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_vdb(CLI::App* app, int* result) {
  auto config = std::make_shared<VdbConfig>();
  CLI::App* command = app->add_subcommand("vdb", "Compare every voxel with an OpenVDB grid");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  command->add_option("GRID", config->vdb, "The .vdb file")->required();
  command->add_option("--grid", config->grid, "Which grid of the .vdb (default: the only one)")
      ->type_name("NAME");
  command
      ->add_option_function<std::string>(
          "--iso", [config](const std::string& text) { config->iso = parse_iso(text); },
          "The values of a float grid that count as set, for example --iso=-inf,0")
      ->type_name("LOW,HIGH");
  command
      ->add_option_function<std::string>(
          "--bounds", [config](const std::string& text) { config->bounds = parse_bounds(text); },
          "Compare only this box, in scene units")
      ->type_name("x0,y0,z0,x1,y1,z1");
  command->add_option("--show", config->show, "Differing voxels to list of each kind (default 10)")
      ->type_name("N");
  command
      ->add_option("--write-diff", config->write_diff,
                   "Write two mask grids, missing and extra, in the place of GRID")
      ->type_name("X.vdb");
  const auto set_most = [config](const std::string& text) {
    config->write_most = parse_count(text, "--write-most");
  };
  command
      ->add_option_function<std::string>(
          "--write-most", set_most, "Refuse to write more extra voxels than this (default 10M)")
      ->type_name("N");
  add_common(command, &config->common, true);
  command->footer(std::string("Example: svdag-verify vdb scene.svdag scene.vdb\n") + kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_light(CLI::App* command, RenderCommandConfig* config) {
  command
      ->add_option("--light", config->light,
                   "Where the light is, and how large (default: over the left shoulder)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("x,y,z[,radius]");
  command
      ->add_option("--samples", config->samples,
                   "soft, ao: rays to the light or sky for each camera ray (default 16)")
      ->type_name("N");
  command
      ->add_option("--reach", config->reach,
                   "ao: how far they reach (default: a twentieth of the scene)")
      ->type_name("LENGTH");
  command
      ->add_option("--cone", config->cone,
                   "soft, ao: half the angle of the cone in which they end early (default: ao 9, "
                   "soft 0, which is exact)")
      ->type_name("DEGREES");
}

void add_render(CLI::App* app, int* result) {
  auto config = std::make_shared<RenderCommandConfig>();
  CLI::App* command =
      app->add_subcommand("render", "Make a picture by tracing rays through the DAG");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  command->add_option("-o,--output", config->output, "The PNG to write")
      ->required()
      ->type_name("X.png");
  command->add_option("--mode", config->mode,
                      "primary, shadow, soft, ao, normal, depth, level or steps (default primary)");
  command->add_option("--size", config->size, "Pixels (default 1280x720)")->type_name("WxH");
  command
      ->add_option("--camera", config->camera,
                   "Position, target and angle of view in degrees (default: frames all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("px,py,pz,tx,ty,tz[,fov]");
  command->add_option("--preset", config->preset,
                      "iso, front, back, left, right, top or inside, without --camera "
                      "(default iso)");
  add_light(command, config.get());
  command->add_option("--level", config->level, "Trace the cubes of level K instead of the voxels")
      ->type_name("K");
  command->add_option("--fly", config->fly, "N frames of a turn, into X_0001.png, X_0002.png, ...")
      ->type_name("N");
  command->add_option("--up", config->up, "The axis that points up: x, y or z (default y)");
  command->add_option("--supersample", config->supersample, "n x n rays per pixel (default 2)");
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  command->footer(
      std::string(
          "Examples: svdag-verify render scene.svdag -o scene.png\n"
          "          svdag-verify render scene.svdag -o ao.png --mode ao --preset inside\n"
          "          svdag-verify render scene.svdag -o in.png --camera=-9,2,0,8,3,0,65\n") +
      kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_diff(CLI::App* app, int* result) {
  auto config = std::make_shared<DiffConfig>();
  CLI::App* command =
      app->add_subcommand("diff", "Count and list the voxels that only one DAG has");
  command->add_option("A", config->a, "A .svdag file")->required();
  command->add_option("B", config->b, "Another; one of other resolution is compared at the coarser")
      ->required();
  command->add_option("--show", config->show, "How many differing voxels to list (default 10)")
      ->type_name("N");
  command->add_flag("--by-index", config->by_index,
                    "Compare voxel by voxel although the grids lie in different places");
  command
      ->add_option("--write-diff", config->write_diff,
                   "Write the differing voxels as a PLY of points: red only A, blue only B")
      ->type_name("X.ply");
  add_count(command, "--write-most", &config->write_most,
            "Refuse to write more points than this (default 10M)");
  add_common(command, &config->common, true);
  command->footer(std::string("Example: svdag-verify diff old.svdag new.svdag\n") + kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_trace(CLI::App* app, int* result) {
  auto config = std::make_shared<TraceConfig>();
  CLI::App* command = app->add_subcommand(
      "trace", "Send rays through the DAG and through the triangles (by Embree), and compare");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  add_scene(command, &config->scene);
  add_count(command, "--rays", &config->rays, "How many rays (default 1,000,000)");
  command->add_option("--seed", config->seed, "Seed of the rays (default 1)")->type_name("N");
  add_memory(command, &config->memory);
  add_threads(command, &config->common);
  add_common(command, &config->common, true);
  command->footer(std::string("Example: svdag-verify trace sponza.svdag sponza.glb\n") +
                  kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

void add_report(CLI::App* app, int* result) {
  auto config = std::make_shared<ReportConfig>();
  CLI::App* command = app->add_subcommand(
      "report", "Make a page of HTML of a bake: pictures, verdicts, levels, times");
  command->add_option("FILE", config->file, "The .svdag file")->required();
  command->add_option("REPORT", config->bake, "What svdag build --report wrote of it")->required();
  command->add_option("-o,--output", config->output, "The page to write")
      ->required()
      ->type_name("R.html");
  command->add_option("--up", config->up, "The axis that points up: x, y or z (default y)");
  command->add_option("--size", config->size, "Pixels of a picture (default 960x540)")
      ->type_name("WxH");
  add_threads(command, &config->common);
  add_common(command, &config->common, false);
  command->footer(std::string("Example: svdag-verify report a.svdag a.json -o a.html\n") +
                  kExitCodes);
  command->callback([config, result] { *result = run(*config); });
}

int run_judge(int argc, char** argv) {
  CLI::App app("Judges .svdag files independently of the builder.", "svdag-verify");
  app.set_version_flag("--version", "svdag-verify " SVDAG_VERSION);
  app.require_subcommand(1);
  app.footer(std::string("Example: svdag-verify mesh scene.svdag scene.ply\n") + kExitCodes);
  int result = 0;
  add_check(&app, &result);
  add_mesh(&app, &result);
  add_diff(&app, &result);
  add_vdb(&app, &result);
  add_trace(&app, &result);
  add_render(&app, &result);
  add_report(&app, &result);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    fail_usage(explain(app, argc, argv, error));
  }
  return result;
}

}  // namespace
}  // namespace svdag

int main(int argc, char** argv) {
  return svdag::run_program({"svdag-verify", "this machine has too little memory for that"},
                            [&] { return svdag::run_judge(argc, argv); });
}
