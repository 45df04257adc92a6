#include "builder/split/split.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "builder/overlap/exact.h"
#include "builder/split/open_edges.h"
#include "io/lattice.h"
#include "io/scene/open_parts.h"
#include "streaming/error.h"
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
      if (bins_) {
        bins_->add(triangle);
        continue;
      }
      tree_->add(triangle);
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
    tree_->for_each_triangle([&](const LatticeTriangle& t) { bins_->add(t); });
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
    const std::string name = path.substr(path.find_last_of('/') + 1);
    if (!names.insert(name).second)
      fail_usage("--layers file: two files of the scene are named " + name + ": rename one");
  }
}

// Of the tetrahedron on the triangle with its apex at the grid's corner, in voxels. The sum over a
// closed surface is the volume that it winds around.
double volume_of(const LatticeTriangle& t, int fraction) {
  const Point a(t.v[0]), b(t.v[1]), c(t.v[2]);
  return std::ldexp(glm::dot(a, glm::cross(b, c)) / 6, -3 * fraction);
}

BoundaryChain boundary_chain(const Scene& scene, const Grid& grid) {
  const Lattice lattice(grid);
  BoundaryChain chain;
  scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles)
      chain.add(
          LatticeTriangle{{lattice.snap(t.v[0]), lattice.snap(t.v[1]), lattice.snap(t.v[2])}});
  });
  return chain;
}

// Error (kBadInput) unless the rule is defined for the surface.
void require_closed(const Scene& scene, const Grid& grid, Rule rule, const EdgeSum& edges) {
  if (is_closed(edges, rule) || is_closed(boundary_chain(scene, grid), rule)) return;
  const OpenEdges open = find_open_edges(scene, grid);
  throw Error(ExitCode::kBadInput,
              open.closed_mod_2
                  ? "the triangles of the scene are not oriented alike at " + describe(open) +
                        ": give --inside odd"
                  : "the scene is not closed: " + describe(open) +
                        ": repair it, or bake its open parts as surfaces with --open surface");
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
  const auto keep = [&](const LatticeTriangle& triangle) {
    kept.triangles.push_back(triangle);
    if (kept.triangles.size() < SnappedBatch::kSize) return;
    kept.outside = counts.outside;
    storing.put(&kept);
    kept.triangles.clear();
  };
  double largest_move = 0;
  result.layers = SceneLayers(config.content.layers);
  std::shared_ptr<CellWindings> windings;
  if (is_solid(config.content.rule)) {
    windings = std::make_shared<CellWindings>(grid.levels, Cube(),
                                              CellWindings::level_of_grid(grid.levels), budget);
  }
  EdgeSum edges;
  OpenParts open, open_layers;
  if (is_solid(config.content.rule) && config.content.open_as_sheets) open = OpenParts(scene, grid, config.content.rule);
  if (is_solid(config.content.rule) && config.content.layers != LayerKind::kNone)
    open_layers = OpenParts(scene, grid, config.content.rule, config.content.layers);
  counts.open_parts = open.size();
  counts.open_layers = open_layers.size();
  const LatticeBox whole = grid.closed(grid.whole());
  const bool layered = config.content.layers != LayerKind::kNone;
  counts.scene = scene.stream([&](const TriangleBatch& batch) {
    const Subject subject = layered ? subject_of(result.layers.layer_of(batch)) : kUnionSet;
    const bool open_part = open.contains(batch);
    const uint32_t sheet =
        (open_part ? kSheetOfUnion : 0) | (open_layers.contains(batch) ? kSheetOfLayer : 0);
    for (const Triangle& triangle : batch.triangles) {
      LatticeTriangle snapped;
      snapped.subject = subject;
      snapped.sheet = sheet;
      double move = 0;
      for (size_t i = 0; i < 3; ++i) snapped.v[i] = lattice.snap(triangle.v[i], &move);
      const BoxPlacement placement = placement_of(snapped, grid, config.part);
      counts.outside += placement == BoxPlacement::kOutside;
      counts.clipped += placement == BoxPlacement::kClipped;
      if (windings) windings->add_with_ray(snapped);
      if (windings && !open_part) {
        edges.add(snapped);
        counts.volume += volume_of(snapped, grid.fraction());
      }
      if (placement == BoxPlacement::kOutside) {
        if (windings && box_of(snapped).meets(whole)) keep(snapped);
        continue;
      }
      counts.degenerate += has_zero_area(snapped);
      largest_move = std::max(largest_move, move);
      keep(snapped);
    }
    if (config.on_batch) config.on_batch(batch.triangles.size());
  });
  kept.outside = counts.outside;
  storing.put(&kept);
  storing.finish();
  store.finish(&result);
  // Of open parts the others were tested alone.
  if (is_solid(config.content.rule) && open.size() == 0) require_closed(scene, grid, config.content.rule, edges);
  if (windings) windings->finish();
  result.windings = std::move(windings);
  counts.largest_snap = std::ldexp(largest_move, -grid.fraction());
  return result;
}

}  // namespace svdag
