#include "builder/colours/colour_file.h"

#include "builder/colours/spilled_colours.h"
#include "io/dag/open_dag.h"
#include "streaming/error.h"
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
  const int levels = file.grid().levels;
  if (config.pass.level && (*config.pass.level < kMinColourLevel || *config.pass.level > levels))
    fail_usage("--colour-level " + std::to_string(*config.pass.level) + ": choose " +
               std::to_string(kMinColourLevel) + " to " + std::to_string(levels));
}

}  // namespace

ColourPassReport colour_file(const ColourFileConfig& config, const WriteColoured& write,
                             Executor* executor, Progress* progress) {
  Workspace workspace(ScratchDir::path_for(config.output, config.scratch), config.memory,
                      executor->workers());
  workspace.clear(config.output, kUnfinishedHint);
  const WorkRoom room = workspace.room();
  const DagFile file = open_dag(config.file, {}, &room);
  check_file(config, file);
  SpilledColours colours(workspace.scratch());
  ColourPassReport report;
  {
    SpillSpace vertices = workspace.vertices();
    const Scene scene(scene_of(config, file), workspace.budget(), &vertices);
    report = scene.watch().guard([&] {
      return colour_cubes(file, scene, config.pass, &workspace, executor, progress,
                          [&](std::span<const CubeColour> entries) { colours.add(entries); });
    });
  }
  colours.finish();
  progress->phase("write", 0);
  write(
      file, report.level, [&] { return colours.next(); }, room);
  progress->finish();
  return report;
}

}  // namespace svdag
