#include "builder/colour_file.h"

#include "builder/bake/checkpoint.h"
#include "builder/bake/colour_stage.h"
#include "builder/bake/description.h"
#include "io/dag/open_dag.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/process/lap_timer.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {
namespace {

// The scene as it was for the bake of `file`, with colours.
SceneConfig scene_of(const ColourFileConfig& config, const DagFile& file) {
  SceneConfig scene = config.scene;
  const Affine given = scene.to_world();
  if (given != Affine() && given != file.grid().transform)
    fail_usage("--transform, --up, --scale: " + config.file +
               " was built with others: leave them out, they are in the file");
  scene.transform = file.grid().transform;
  scene.up = Affine();
  scene.scale = 1;
  scene.colours = scene.paint = true;
  return scene;
}

void check_file(const ColourFileConfig& config, const DagFile& file) {
  if (!file.layers().empty() && !file.layers().has_union)
    fail_usage(config.file + ": has no union (--no-union, --frames), and colours belong to it");
  check_colour_level(config.pass, file.grid().levels);
}

ColourReport colour_resumably(const ColourFileConfig& config, Executor* executor,
                              Progress* progress) {
  LapTimer total;
  Workspace workspace(ScratchDir::path_for(config.output, config.scratch), config.memory,
                      executor->workers());
  const WorkRoom room = workspace.room();
  Checkpoint checkpoint(&workspace);
  if (workspace.has_unfinished_bake()) workspace.folder()->keep();  // whatever is wrong with `file`
  const DagFile file = open_dag(config.file, {}, &room);
  check_file(config, file);
  const SceneConfig scene = scene_of(config, file);
  const std::function<std::string()> description = [&] {
    const std::vector<SceneFile> files = scene_files(Scene(scene, workspace.budget()));
    return describe_colours(config.pass, scene, to_hex(file.header().content_hash), files);
  };
  ColourReport report;
  std::optional<SavedBake> saved = checkpoint.find(config.output, config.unfinished, description);
  checkpoint.run(saved.has_value(), [&] {
    const InputWatch watch = Scene(scene, workspace.budget()).watch();
    report = colour({config.pass, config.output, config.checkpoint, file, scene, watch, description,
                     &workspace, &checkpoint, executor, progress},
                    std::move(saved));
    checkpoint.discard();
  });
  progress->finish();
  report.scratch = workspace.scratch()->peak_bytes();
  report.seconds = total.lap();
  return report;
}

}  // namespace

ColourReport colour_file(const ColourFileConfig& config, Executor* executor, Progress* progress) {
  try {
    return colour_resumably(config, executor, progress);
  } catch (const InvalidScratch&) {
    if (config.unfinished != Unfinished::kResumeSame) throw;
  }
  ColourFileConfig fresh = config;
  fresh.unfinished = Unfinished::kRestart;
  return colour_resumably(fresh, executor, progress);
}

}  // namespace svdag
