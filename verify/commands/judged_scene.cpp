#include "verify/commands/judged_scene.h"

#include <cstdio>

#include "io/dag/dag_file.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/printable.h"

namespace svdag {

namespace {

// The scene as the file says that it was placed.
SceneConfig placed(SceneConfig config, const Grid& grid) {
  config.transform = grid.transform;
  return config;
}

}  // namespace

JudgedScene::JudgedScene(const SceneConfig& config, uint64_t memory, Progress::Mode mode,
                         const Grid& grid)
    : budget(memory_or_default(memory)), scene(placed(config, grid), &budget), progress(mode) {
  progress.phase("reading the scene's bounds", 0);
  const Box bounds = scene.bounds(&facts.counts);
  facts.grid = judge_grid(grid, bounds);
}

void judge_header(const DagFile& file, uint64_t voxels, const SnapCounts& whole_scene,
                  GridJudgement* grid) {
  const uint64_t header_voxels = file.header().voxels;
  if (voxels != header_voxels)
    grid->defects.push_back("the header counts " + format_count(header_voxels) +
                            " voxels, the file has " + format_count(voxels));
  const std::string defect = snap_defect(file.header().largest_snap, whole_scene);
  if (!defect.empty()) grid->defects.push_back(defect);
}

void print_facts(const DagFile& file, const SceneFacts& facts, const std::string& judge) {
  std::printf("grid       %s%s\n", describe_grid(file).c_str(),
              facts.grid.recomputed ? ", matches the scene's bounds" : "");
  for (const std::string& defect : facts.grid.defects)
    std::printf("defect     %s\n", defect.c_str());
  std::printf("judge      %s\n", judge.c_str());
  std::printf("triangles  %s", format_count(facts.counts.triangles).c_str());
  if (facts.counts.invalid > 0)
    std::printf(", %s invalid ones skipped", format_count(facts.counts.invalid).c_str());
  std::printf("\n");
  for (const std::string& pattern : facts.counts.unmatched)
    std::printf("unmatched  %s\n", printable(pattern).c_str());
}

void require_union(const DagFile& file, const char* what) {
  if (!file.layers().has_union)
    fail_usage(file.path() + ": has layers without their union, which " + what +
               " would judge: use svdag-verify mesh, or one layer (svdag convert --layer)");
}

std::array<int64_t, 6> selection_of(const DagFile& file) {
  const auto [min, max] = file.grid().selection;
  return {min.x, min.y, min.z, max.x, max.y, max.z};
}

void require_count(const char* option, uint64_t count) {
  constexpr uint64_t kMax = uint64_t(1) << 40;
  if (count == 0) fail_usage(std::string(option) + ": give at least one");
  if (count > kMax) fail_usage(std::string(option) + ": give at most " + format_count(kMax));
}

void print_wrong_voxels(const Grid& grid, uint64_t missing, uint64_t extra,
                        const std::vector<WrongVoxel>& first) {
  std::printf("missing    %s\nextra      %s\n", format_count(missing).c_str(),
              format_count(extra).c_str());
  const Point corner = grid.corner();
  for (const WrongVoxel& wrong : first) {
    const LatticePoint& v = wrong.voxel;
    const auto world = [&](int a) { return corner[a] + (double(v[a]) + 0.5) * grid.voxel_size; };
    std::printf("  %s voxel (%lld, %lld, %lld) at (%.9g, %.9g, %.9g)\n",
                wrong.missing ? "missing" : "extra  ", static_cast<long long>(v.x),
                static_cast<long long>(v.y), static_cast<long long>(v.z), world(0), world(1),
                world(2));
  }
}

}  // namespace svdag
