#include "verify/trace/program/trace_options.h"

#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "streaming/error.h"

namespace svdag {

namespace {

void add_output_options(CLI::App* app, TraceOptions* options) {
  takes_files(
      app->add_option("--dump", options->dump,
                      "Write 56 bytes per pixel, little-endian: u32 found, x, y, z, level, axis; "
                      "f64 t; u32 blocked rays of shadow, soft, ao; "
                      "u32 1 + layer (0: none), 0, 0"),
      {"*"})
      ->type_name("FILE");
  takes_files(app->add_option_function<std::string>(
                  "--picture",
                  [=](const std::string& name) {
                    reject_other_picture_format(name, ".ppm",
                                                "pictures are PPM: choose a name in .ppm "
                                                "(svdag-verify render: PNG)");
                    options->picture = name;
                  },
                  "Write a picture of the result"),
              {".ppm"})
      ->type_name("FILE.ppm");
}

void add_options(CLI::App* app, TraceOptions* options) {
  takes_files(app->add_option("FILE", options->file, "The .svdag file"), {".svdag"})->required();
  one_of(app->add_option("--device", options->device, "cpu or cuda (default cpu)"), {"cpu", "cuda"})
      ->type_name("NAME");
  app->add_flag("--compare", options->compare,
                "Trace on both devices and count the pixels that differ; exit 1 if any does");
  app->add_flag("--json", options->json, "Print one line of JSON instead of the table");
  add_layer(app, &options->layers);
  add_camera(app, &options->view);
  add_rays(app, &options->view, {"above the scene", "64", "unlimited", "0, which is exact"});
  app->add_flag_callback(
      "--no-beams", [=] { options->beams = false; },
      "Primary rays start at the camera (same hits)");
  app->add_flag("--gpu-tree", options->gpu_tree,
                "A GPU traces a 64-tree of the file, as the processor does (same hits)");
  from_to(app->add_option("--rounds", options->rounds,
                          "Repeat N times and report the shortest time (default 3)"),
          1, 1000)
      ->type_name("N");
  from_to(
      app->add_option("-j,--threads", options->threads, "Threads of the processor (default: all)"),
      1, 1024)
      ->type_name("N");
  add_output_options(app, options);
  add_examples(app, {"svdag-trace city.svdag --preset inside --cone 9"},
               "Sizes and pointers of the file are validated before tracing, but not its "
               "checksums: svdag-verify check proves that it is what was baked.");
}

}  // namespace

std::optional<TraceOptions> parse_trace_options(int argc, char** argv) {
  CLI::App app(
      "Traces rays through a .svdag on the processor or a GPU, and counts them per second.",
      "svdag-trace");
  app.set_version_flag("-V,--version", "svdag-trace " SVDAG_VERSION, "Print the version and exit");
  TraceOptions options;
  add_options(&app, &options);
  if (read_command_line(&app, argc, argv)) return std::nullopt;
  return options;
}

Workload make_workload(const TraceOptions& options, const PlainFile& file) {
  if (file.view.empty()) fail_usage(options.file + ": has no voxel to trace");
  const ViewOptions& view = options.view;
  const VoxelBounds box = framing_bounds(file.view);
  Workload work{
      {camera_of(view, file.view, box), uint32_t(view.size.width), uint32_t(view.size.height)},
      {},
      {}};
  work.light.centre = (box.min + box.max) * 0.5;
  const bool inside = view.camera.empty() && view.preset == "inside";
  work.light.centre[view.up] += (inside ? 0.4 : 1.5) * (box.max[view.up] - box.min[view.up]);
  work.light.radius = 0.02 * length(box.max - box.min);
  apply_light(view, file.view, &work.light);
  apply_rays(view, file.view, &work.secondary);
  work.beams = options.beams;
  work.gpu_tree = options.gpu_tree;
  work.rounds = options.rounds;
  work.threads = options.threads;
  return work;
}

}  // namespace svdag
