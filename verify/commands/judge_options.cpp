// The commands that judge: check, mesh, colours, diff, vdb and trace.
#include <CLI/CLI.hpp>

#include "io/help/command_line.h"
#include "io/help/scene_options.h"
#include "io/units.h"
#include "verify/commands/options.h"

namespace svdag {

void add_check(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<CheckConfig>();
  CLI::App* command =
      app->add_subcommand("check", "Prove every checksum and pointer, order and minimality");
  add_file(command, &config->file);
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify check scene.svdag"});
  command->callback([=] { *parsed = *config; });
}

void add_mesh(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<MeshConfig>();
  CLI::App* command = app->add_subcommand(
      "mesh", "Voxelize the scene again, by other means, and compare every voxel");
  add_file(command, &config->file);
  add_frames(command, &config->scene, [] {});
  add_scene(command, &config->scene);
  one_of(command->add_option(
             "--judge", config->judge,
             "The judge: integer (our exact clipping, the default), cgal (CGAL's exact "
             "kernel; slow) or openvdb (two bounds by its distances)"),
         {"integer", "cgal", "openvdb"})
      ->type_name("JUDGE");
  add_count(command, "--sample", &config->sample,
            "Compare N bricks drawn from file and scene instead of all, and bound what share of "
            "either is wrong (openvdb: the windows of 512^3 voxels that hold them)");
  takes_whole_number(command->add_option("--seed", config->seed, "Seed of the sample (default 1)"))
      ->type_name("N");
  add_memory(command, &config->memory);
  add_threads(command, &config->common);
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify mesh sponza.svdag sponza.glb",
                         "svdag-verify mesh --sample 100000 city.svdag city.ply --json"});
  command->callback([=] { *parsed = *config; });
}

void add_colours(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<ColoursConfig>();
  CLI::App* command = app->add_subcommand(
      "colours", "Compute colours of the scene again, by other means, and compare");
  add_file(command, &config->file);
  add_scene(command, &config->scene);
  add_count(command, "--sample", &config->sample,
            "How many of the cubes to draw and compare (default 10,000; all if there are fewer)");
  takes_whole_number(command->add_option("--seed", config->seed, "Seed of the sample (default 1)"))
      ->type_name("N");
  add_memory(command, &config->memory);
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify colours painted.svdag scene.glb"});
  command->callback([=] { *parsed = *config; });
}

void add_diff(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<DiffConfig>();
  CLI::App* command =
      app->add_subcommand("diff", "Count and list the voxels that only one DAG has");
  takes_files(command->add_option("A", config->a, "A .svdag file"), {".svdag"})->required();
  takes_files(
      command->add_option("B", config->b,
                          "Another .svdag file; if resolutions differ, the coarser is compared"),
      {".svdag"})
      ->required();
  takes_whole_number(
      command->add_option("--show", config->show, "How many differing voxels to list (default 10)"))
      ->type_name("N");
  add_selection(command, &config->selection);
  command->add_flag("--by-index", config->by_index,
                    "Compare voxel by voxel although the grids have different positions");
  takes_files(
      command->add_option("--write-diff", config->write_diff,
                          "Write the differing voxels as a PLY of points: red only A, blue only B"),
      {".ply"})
      ->type_name("X.ply");
  add_count(command, "--write-most", &config->write_most,
            "Refuse to write more points than this (default 10M)");
  takes_files(command->add_option("--render", config->render,
                                  "Draw both: voxels of both grey, of only A red, of only B blue"),
              {".png"})
      ->type_name("X.png");
  add_size(command, &config->size, "Pixels of --render");
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify diff old.svdag new.svdag",
                         "svdag-verify diff old.svdag new.svdag --render changes.png"});
  command->callback([=] { *parsed = *config; });
}

void add_vdb(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<VdbConfig>();
  CLI::App* command = app->add_subcommand("vdb", "Compare every voxel with an OpenVDB grid");
  add_file(command, &config->file);
  takes_files(command->add_option("GRID", config->vdb, "The .vdb file"), {".vdb"})->required();
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
  command->add_flag("--sandbox", config->sandbox,
                    "Decode in a process that can only compute, for untrusted files");
  takes_whole_number(command->add_option("--show", config->show,
                                         "Differing voxels to list of each kind (default 10)"))
      ->type_name("N");
  takes_files(
      command->add_option("--write-diff", config->write_diff,
                          "Write two grids, missing and extra, with the position and axes of GRID"),
      {".vdb"})
      ->type_name("X.vdb");
  add_count(command, "--write-most", &config->write_most,
            "Refuse to write more extra voxels than this (default 10M)");
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify vdb scene.svdag scene.vdb"});
  command->callback([=] { *parsed = *config; });
}

void add_trace(CLI::App* app, VerifyCommand* parsed) {
  auto config = std::make_shared<TraceConfig>();
  CLI::App* command = app->add_subcommand(
      "trace", "Send rays through the DAG and through the triangles (by Embree), and compare");
  add_file(command, &config->file);
  add_scene(command, &config->scene);
  add_count(command, "--rays", &config->rays, "How many rays (default 1,000,000)");
  takes_whole_number(command->add_option("--seed", config->seed, "Seed of the rays (default 1)"))
      ->type_name("N");
  add_memory(command, &config->memory);
  add_threads(command, &config->common);
  add_common(command, &config->common, true);
  add_examples(command, {"svdag-verify trace sponza.svdag sponza.glb"});
  command->callback([=] { *parsed = *config; });
}

}  // namespace svdag
