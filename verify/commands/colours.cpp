#include "io/colour.h"
#include "io/dag/colours/chunk_view.h"
#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "verify/colours/colour_judge.h"
#include "verify/commands/commands.h"
#include "verify/commands/judged_scene.h"

namespace svdag {
namespace {

std::string colour_or_none(uint32_t colour) {
  if (colour == kNoColour) return "none";
  return colour_text({uint8_t(colour), uint8_t(colour >> 8), uint8_t(colour >> 16)});
}

Colour expected_colour(const WrongColour& w) {
  return {colour_code(w.expected[0] / 255), colour_code(w.expected[1] / 255),
          colour_code(w.expected[2] / 255)};
}

void add_wrong_colours(Verdict* verdict, const ColourComparison& c) {
  verdict->for_programs("worst", FigureValue::List());
  for (size_t i = 0; i < c.worst.size(); ++i) {
    const WrongColour& w = c.worst[i];
    const std::string key = "worst/" + std::to_string(i) + "/";
    verdict->add(key + "cube", "  wrong",
                 shown(std::array{w.cube.x, w.cube.y, w.cube.z},
                       "cube (" + std::to_string(w.cube.x) + ", " + std::to_string(w.cube.y) +
                           ", " + std::to_string(w.cube.z) + ")"));
    verdict->also(key + "stored", colour_or_none(w.stored));
    verdict->also(key + "expected", shown(colour_text(expected_colour(w)),
                                          "the scene has " + colour_text(expected_colour(w))));
    verdict->also(key + "excess", rounded(w.excess, "%.1f"), "steps beyond what is allowed");
  }
}

Verdict verdict_of(const DagFile& file, const SceneFacts& facts, const ColourComparison& c) {
  Verdict verdict = judged_verdict("colours", file, facts,
                                   "points on the triangles, textures by libpng and libjpeg-turbo");
  const double error = double(file.header().colour_error) / kColourErrorUnit;
  verdict.add(
      "level", "colours",
      shown(file.header().colour_level, "of level " + std::to_string(file.header().colour_level)));
  verdict.also("error", shown(error, "stored within " + format_double(error) + " of 255 steps"));
  verdict.add("covered", "cubes", c.covered, "covered");
  verdict.also("drawn", c.drawn, "drawn");
  verdict.also("judged", c.judged, "judged");
  verdict.add("without_mean", "  left out", c.without_mean, "that triangles only touch");
  verdict.also("without_colour", c.without_colour, "without a triangle or a colour");
  verdict.hide(c.judged == 0);
  verdict.add("difference_mean", "difference", rounded(c.mean, "mean %.3f"));
  verdict.also("difference_999", rounded(c.permille_999, "99.9 %% %g"));
  verdict.also("difference_largest", rounded(c.largest, "largest %g"), "steps of sRGB");
  verdict.add("difference_at_seams", "  at seams", rounded(c.mean_at_seams, "mean %.3f"));
  verdict.also("at_seams", c.at_seams, "cubes");
  verdict.add("allowed_mean", "allowed", rounded(c.mean_allowed, "mean %.2f"), "steps");
  verdict.hide(false);
  verdict.add("wrong", "wrong", c.wrong, "cubes");
  add_wrong_colours(&verdict, c);
  const bool ok = c.agrees() && facts.grid.defects.empty();
  verdict.add("ok", "",
              shown(ok, ok ? "ok: no drawn cube has a colour that its triangles do not have"
                           : "not ok: file and scene differ"));
  return verdict;
}

}  // namespace

int run(const ColoursConfig& config) {
  const Stopwatch stopwatch(config.common);
  require_count("--sample", config.sample);
  const DagFile file = open_judged(config.file, config.scene);
  if (!file.has_colours()) fail_usage(file.path() + ": has no colours: add them with svdag colour");
  SceneConfig scene = config.scene;
  scene.colours = scene.paint = scene.keep_images = true;
  JudgedScene judged(scene, config.memory, config.common.progress, file.grid());
  const ColourComparison comparison = compare_colours(
      judged.scene, file, {config.sample, config.seed}, &judged.budget, &judged.progress);
  judged.progress.finish();
  if (comparison.without_triangle > 0)
    fail_input(file.path(),
               "does not belong to this scene: " + format_count(comparison.without_triangle) +
                   " of " + format_count(comparison.drawn) +
                   " drawn cubes have no triangle: give the scene, options and pose that it was "
                   "built with");
  return finish(config.common, verdict_of(file, judged.facts, comparison),
                comparison.agrees() && judged.facts.grid.defects.empty());
}

}  // namespace svdag
