// svdag-verify mesh --judge openvdb: tests that voxels are between two bounds by OpenVDB's
// distances.
#include "verify/compare/distance_bounds.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "verify/commands/judged_scene.h"
#include "verify/commands/mesh.h"
#include "verify/sample/sample.h"
#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

struct BoundsJudgement : SceneFacts {
  BoundsComparison bounds;
  bool both_empty = false;  // sampled, but file and scene are empty in the selection

  bool ok() const { return grid.defects.empty() && bounds.holds(); }
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
      scene, grid, [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
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

BoundsJudgement judge(const MeshConfig& config, const DagFile& file) {
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

void print_text(const DagFile& file, const BoundsJudgement& j, bool sampled) {
  const BoundsComparison& bounds = j.bounds;
  const bool thin = file.rule() == Rule::kThin;
  print_facts(file, j,
              std::string("openvdb: distances of its mesh-to-volume, ") +
                  (thin ? "file in {d <= 1/2}" : "{d <= 1/2} in file in {d <= sqrt(3)/2}"));
  std::printf("windows    %s %s, %s voxels tested\n", format_count(bounds.windows).c_str(),
              sampled ? "sampled" : "(all)", format_count(bounds.tested).c_str());
  std::printf("voxels     %s in the file, %s with d <= 1/2\n",
              format_count(bounds.file_voxels).c_str(), format_count(bounds.inner).c_str());
  print_wrong_voxels(file.grid(), bounds.missing, bounds.extra, bounds.first);
  std::printf("exact      %s on a bound within the error of a float, decided in integers\n",
              format_count(bounds.exact).c_str());
  if (bounds.vdb_errors > 0)
    std::printf("openvdb    %s of its distances were too large, as integers prove\n",
                format_count(bounds.vdb_errors).c_str());
  std::printf("%s\n", !j.ok()        ? "not ok: file and scene differ"
                      : j.both_empty ? kNothingToJudge
                                     : "ok: every voxel tested is between the bounds");
}

void print_json(const DagFile& file, const BoundsJudgement& j, bool sampled) {
  const BoundsComparison& bounds = j.bounds;
  nlohmann::json wrong = nlohmann::json::array();
  for (const WrongVoxel& w : bounds.first)
    wrong.push_back({{"voxel", {w.voxel.x, w.voxel.y, w.voxel.z}}, {"missing", w.missing}});
  const nlohmann::json json = {{"command", "mesh"},
                               {"file", file.path()},
                               {"content_hash", to_hex(file.header().content_hash)},
                               {"ok", j.ok()},
                               {"rule", rule_name(file.rule())},
                               {"judge", "openvdb"},
                               {"grid_defects", j.grid.defects},
                               {"grid_recomputed", j.grid.recomputed},
                               {"bounded", file.grid().bounded},
                               {"selection", selection_of(file)},
                               {"triangles", j.counts.triangles},
                               {"invalid_triangles", j.counts.invalid},
                               {"patterns_unmatched", j.counts.unmatched},
                               {"sampled", sampled},
                               {"windows", bounds.windows},
                               {"tested", bounds.tested},
                               {"file_voxels", bounds.file_voxels},
                               {"inner", bounds.inner},
                               {"missing", bounds.missing},
                               {"extra", bounds.extra},
                               {"decided_exactly", bounds.exact},
                               {"openvdb_errors", bounds.vdb_errors},
                               {"first_wrong", wrong}};
  std::printf("%s\n", json_text(json).c_str());
}

}  // namespace

int run_distance_bounds(const MeshConfig& config, const DagFile& file) {
  const BoundsJudgement judgement = judge(config, file);
  if (config.common.json) {
    print_json(file, judgement, config.sample.has_value());
  } else if (!config.common.quiet) {
    print_text(file, judgement, config.sample.has_value());
  }
  return int(judgement.ok() ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
