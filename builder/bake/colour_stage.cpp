#include "builder/bake/colour_stage.h"

#include "builder/colours/spilled_colours.h"
#include "io/dag/colours/colour_writer.h"
#include "streaming/process/lap_timer.h"

namespace svdag {
namespace {

ColourPassReport spill_colours(const ColourStage& stage, uint64_t begin, SpilledColours* colours) {
  SpillSpace vertices = stage.workspace->vertices();
  const Scene scene(stage.scene, stage.workspace->budget(), &vertices);
  LapTimer timer;
  double unsaved = 0;  // seconds
  const auto save = [&](uint64_t end) {
    unsaved += timer.lap();
    if (unsaved < stage.checkpoint) return;
    unsaved = 0;
    stage.watch.check();
    if (!stage.journal->begun()) stage.journal->begin(stage.description(), stage.file.grid());
    stage.journal->save_colours(end, colours->cut());
  };
  return stage.watch.guard([&] {
    return colour_cubes(
        stage.file, scene, stage.pass, stage.workspace, stage.executor, stage.progress,
        [&](std::span<const CubeColour> entries) { colours->add(entries); }, begin, save);
  });
}

}  // namespace

ColourReport colour(const ColourStage& stage, std::optional<SavedBake> saved) {
  LapTimer timer;
  ColourReport report;
  SpilledColours colours(stage.workspace->scratch());
  uint64_t begin = 0;
  if (saved) {
    report.resumed = saved->coloured > 0;
    begin = saved->coloured;
    colours.restore(std::move(saved->colours));
  }
  static_cast<ColourPassReport&>(report) = spill_colours(stage, begin, &colours);
  const SpillStream last = colours.cut();
  if (stage.journal->begun())
    stage.journal->save_colours(uint64_t(1) << 3 * stage.file.grid().levels, last);
  stage.progress->phase("write", 0);
  report.header = write_coloured(
      stage.file, {uint32_t(report.level), stage.pass.error}, [&] { return colours.next(); },
      stage.output, stage.workspace->room(), stage.executor);
  report.seconds = timer.lap();
  return report;
}

}  // namespace svdag
