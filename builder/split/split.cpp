#include "builder/split/split.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "builder/overlap/exact.h"
#include "builder/split/solid_watch.h"
#include "io/lattice.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/process/stage.h"

namespace svdag {
namespace {

enum class BoxPlacement { kInside, kClipped, kOutside };

// Position of the triangle's box relative to the closed box of the selection. A box that misses the
// closed grid part is outside as well.
BoxPlacement placement_of(const LatticeTriangle& t, const Grid& grid, const GridPart* part) {
  const LatticeBox selection = grid.closed(grid.selection), box = box_of(t);
  if (!box.meets(selection) || (part != nullptr && !part->meets(box)))
    return BoxPlacement::kOutside;
  return selection.holds(box) ? BoxPlacement::kInside : BoxPlacement::kClipped;
}

bool has_zero_area(const LatticeTriangle& t) {
  const LatticePoint p = t.v[1] - t.v[0], q = t.v[2] - t.v[0];
  for (int u = 0; u < 3; ++u) {
    const int v = (u + 1) % 3;
    if (__int128(p[u]) * q[v] != __int128(p[v]) * q[u]) return false;
  }
  return true;
}

struct SnappedBatch {
  static constexpr size_t kSize = 1024;

  std::vector<LatticeTriangle> triangles;  // that are kept
  CutRecords cuts;                         // of those that are cut
  uint64_t outside = 0;                    // dropped since the scene's first triangle
};

// Collects the triangles: in the cell tree until they exceed their memory, then in bins.
class TriangleStore {
 public:
  TriangleStore(const Grid& grid, const SplitConfig& config, MemoryBudget* budget)
      : grid_(grid),
        config_(config),
        tree_(std::make_unique<CellTree>(grid, Cube(), config.cell_level, budget)) {}

  void add(const SnappedBatch& batch) {
    outside_ = batch.outside;
    for (const LatticeTriangle& triangle : batch.triangles) {
      const CutRecord* const cut = cut_record_of(triangle, batch.cuts);
      if (bins_) {
        bins_->add(triangle, cut);
        continue;
      }
      tree_->add(triangle, cut);
      if (tree_->triangles() % kTrianglesPerCheck == 0) spill_if_full();
    }
  }

  void finish(SplitScene* scene) {
    if (!bins_) spill_if_full();
    if (bins_) {
      scene->bins = bins_->finish();
    } else {
      tree_->seal();
      scene->tree = std::move(tree_);
    }
  }

 private:
  static constexpr uint64_t kTrianglesPerCheck = 1024;  // of the memory

  void spill_if_full() {
    if (config_.scratch == nullptr || tree_->bytes(config_.workers) <= config_.triangle_bytes)
      return;
    const int depth =
        TriangleBins::depth_for(config_.triangle_bytes, *config_.scratch, grid_, Cube());
    bins_.emplace(grid_, Cube(), depth, config_.scratch->triangles(), config_.scratch);
    tree_->for_each_triangle(
        [&](const LatticeTriangle& t) { bins_->add(t, cut_record_of(t, tree_->cuts())); });
    if (config_.on_spill) config_.on_spill(tree_->triangles() + outside_, bins_->bytes());
    tree_.reset();
  }

  const Grid& grid_;
  const SplitConfig& config_;
  std::unique_ptr<CellTree> tree_;
  std::optional<TriangleBins> bins_;
  uint64_t outside_ = 0;
};

// A layer of a file has its name without the folder.
void require_different_names(const std::vector<std::string>& paths) {
  std::set<std::string> names;
  for (const std::string& path : paths) {
    const std::string name = base_name(path);
    if (!names.insert(name).second)
      fail_usage("--layers file: two files of the scene are named " + name + ": rename one");
  }
}

[[noreturn]] void fail_cut_solid(const TriangleBatch& batch) {
  fail_usage("the material \"" + std::string(batch.material) +
             "\" has transparent points, so its surface bounds no solid (--no-cutouts bakes it "
             "whole)");
}

}  // namespace

SplitScene split(const Scene& scene, const Grid& grid, const SplitConfig& config,
                 MemoryBudget* budget) {
  if (config.content.layers == LayerKind::kFile) require_different_names(scene.config().paths);
  const Lattice lattice(grid);
  SplitScene result;
  SplitCounts& counts = result.counts;
  TriangleStore store(grid, config, budget);
  Stage<SnappedBatch> storing(config.workers > 1,
                              [&](const SnappedBatch& batch) { store.add(batch); });
  SnappedBatch kept;
  const auto keep = [&](const LatticeTriangle& triangle, const CutRecord* cut) {
    kept.triangles.push_back(triangle);
    if (cut != nullptr) kept.triangles.back().cut = add_record(*cut, &kept.cuts) & kMaxCut;
    if (kept.triangles.size() < SnappedBatch::kSize) return;
    kept.outside = counts.outside;
    storing.put(&kept);
    kept.triangles.clear();
    kept.cuts.clear();
  };
  double largest_move = 0;
  result.layers = SceneLayers(config.content.layers, scene.config().paths.size() == 1);
  std::optional<SolidWatch> solid;
  if (is_solid(config.content.rule)) solid.emplace(scene, grid, config.content, budget);
  const LatticeBox whole = grid.closed(grid.whole());
  const bool layered = config.content.layers != LayerKind::kNone;
  counts.scene = scene.stream([&](const TriangleBatch& batch) {
    const Subject subject = layered ? subject_of(result.layers.layer_of(batch)) : kUnionSet;
    const uint32_t sheet = solid ? solid->sheet_of(batch) : 0;
    if (batch.cut != nullptr && solid) fail_cut_solid(batch);
    const uint32_t material =
        batch.cut != nullptr ? material_number(*batch.cut, &result.cut_outs) : 0;
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      const Triangle& triangle = batch.triangles[k];
      LatticeTriangle snapped;
      snapped.subject = subject;
      snapped.sheet = sheet & kSheets;
      double move = 0;
      for (size_t i = 0; i < 3; ++i) snapped.v[i] = lattice.snap(triangle.v[i], &move);
      const BoxPlacement placement = placement_of(snapped, grid, config.part);
      counts.outside += placement == BoxPlacement::kOutside;
      counts.clipped += placement == BoxPlacement::kClipped;
      if (solid) solid->add(snapped);
      if (placement == BoxPlacement::kOutside) {
        if (solid && box_of(snapped).meets(whole)) keep(snapped, nullptr);
        continue;
      }
      counts.degenerate += has_zero_area(snapped);
      largest_move = std::max(largest_move, move);
      if (batch.cut == nullptr) {
        keep(snapped, nullptr);
      } else {
        const CutRecord cut = {batch.texture[k], material};
        keep(snapped, &cut);
      }
    }
    if (config.on_batch) config.on_batch(batch.triangles.size());
  });
  kept.outside = counts.outside;
  storing.put(&kept);
  storing.finish();
  store.finish(&result);
  if (solid) {
    result.windings = solid->finish();
    counts.open_parts = solid->open_parts();
    counts.open_layers = solid->open_layers();
    counts.volume = solid->volume();
  }
  counts.largest_snap = std::ldexp(largest_move, -grid.fraction());
  return result;
}

}  // namespace svdag
