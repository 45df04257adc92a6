// svdag-verify mesh --judge openvdb: tests that voxels are between two bounds by OpenVDB's
// distances.
#include "verify/compare/distance_bounds.h"

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "verify/commands/commands.h"
#include "verify/commands/judged_scene.h"
#include "verify/sample/sample.h"
#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

struct BoundsJudgement : SceneFacts {
  BoundsComparison bounds;
  bool both_empty = false;  // sampled, but file and scene are empty in the selection

  bool ok() const { return grid.defects.empty() && bounds.agrees(); }
};

// The windows that contain bricks drawn from the file and the scene (verify/sample/sample.h).
BoundsWindows draw_windows(const MeshConfig& config, const Scene& scene, const DagFile& file,
                           BoundsJudgement* result) {
  const BrickDraw draw =
      draw_bricks(scene, file.view(), file.grid(), file.rule(), *config.sample, config.seed);
  if (draw.untested() && result->grid.defects.empty()) fail_untested();
  result->both_empty = draw.both_empty();
  std::vector<LatticePoint> voxels;
  for (const uint64_t code : draw.all()) voxels.push_back(cell_of_code(code) * int64_t(kBrickSide));
  return BoundsWindows(file.grid(), voxels);
}

// Loads the snapped triangles near any of the windows, or all of them if `all`.
std::vector<LatticeTriangle> load_near(const Scene& scene, const Grid& grid,
                                       const BoundsWindows& windows, bool all,
                                       MemoryBudget::Reservation* held, SnapCounts* snapped) {
  std::vector<LatticeTriangle> near;
  *snapped = stream_snapped(
      scene, grid, nullptr, [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
        for (const LatticeTriangle& t : batch) {
          bool keep = all;
          for (uint64_t i = 0; !keep && i < windows.size(); ++i)
            keep = is_near(t, windows[i], grid.fraction());
          if (keep && near.size() == near.capacity()) {
            const size_t more = std::max<size_t>(4096, near.capacity() * 2);
            held->resize((more + near.capacity()) * sizeof t, "snapped triangles");
            near.reserve(more);
          }
          if (keep) near.push_back(t);
        }
      });
  return near;
}

BoundsJudgement judge_bounds(const MeshConfig& config, const DagFile& file) {
  const Grid grid = file.grid();
  JudgedScene judged(config.scene, config.memory, config.common.progress, grid);
  BoundsJudgement result{judged.facts, {}};
  Progress& progress = judged.progress;
  progress.phase("reading the scene", 0);
  const auto drawn =
      judged.budget.reserve(config.sample.value_or(0) * kBytesOfDraw, "drawn windows");
  const BoundsWindows windows =
      config.sample ? draw_windows(config, judged.scene, file, &result) : BoundsWindows(grid);
  auto held = judged.budget.reserve(0, "snapped triangles");
  SnapCounts snapped;
  const std::vector<LatticeTriangle> triangles =
      load_near(judged.scene, grid, windows, !config.sample, &held, &snapped);
  CubeWalk walk(file.view(), file.header().levels);
  const size_t threads = threads_or_all(config.common.threads);
  progress.phase("comparing windows", windows.size());
  for (uint64_t i = 0; i < windows.size(); ++i) {
    result.bounds.append(judge_window(&walk, grid, file.rule(), windows[i], triangles, threads));
    progress.advance(1);
  }
  if (!config.sample) judge_header(file, result.bounds.file_voxels, snapped, &result.grid);
  progress.finish();
  return result;
}

Verdict verdict_of(const DagFile& file, const BoundsJudgement& j, bool sampled) {
  const BoundsComparison& bounds = j.bounds;
  Verdict verdict =
      judged_verdict("mesh", file, j,
                     std::string("openvdb: distances of its mesh-to-volume, ") +
                         (file.rule() == Rule::kThin ? "file in {d <= 1/2}"
                                                     : "{d <= 1/2} in file in {d <= sqrt(3)/2}"));
  verdict.for_programs("judge", "openvdb");
  verdict.for_programs("sampled", sampled);
  verdict.add("windows", "windows", bounds.windows, sampled ? "sampled" : "(all)");
  verdict.also("tested", bounds.tested, "voxels tested");
  verdict.add("file_voxels", "voxels", bounds.file_voxels, "in the file");
  verdict.also("inner", bounds.inner, "with d <= 1/2");
  add_wrong_voxels(&verdict, file.grid(), bounds);
  verdict.add("decided_exactly", "exact", bounds.exact,
              "on a bound within the error of a float, decided in integers");
  verdict.hide(bounds.vdb_errors == 0);
  verdict.add("openvdb_errors", "openvdb", bounds.vdb_errors,
              "of its distances were too large, as integers prove");
  verdict.hide(false);
  verdict.add("ok", "",
              shown(j.ok(), !j.ok()        ? "not ok: file and scene differ"
                            : j.both_empty ? kNothingToJudge
                                           : "ok: every voxel tested is between the bounds"));
  return verdict;
}

}  // namespace

int run_distance_bounds(const MeshConfig& config, const DagFile& file) {
  const BoundsJudgement judgement = judge_bounds(config, file);
  return finish(config.common, verdict_of(file, judgement, config.sample.has_value()),
                judgement.ok());
}

}  // namespace svdag
