#include "verify/sample/snapped_scene.h"

#include <algorithm>

#include "io/lattice.h"
#include "io/scene/open_parts.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// True if a bake of the whole scene with these bounds would choose this grid.
bool follows_from(const Grid& grid, const Box& bounds) {
  if (grid.bounded) return false;
  try {
    const bool has_origin = grid.kind == Grid::Kind::kOrigin;
    const Grid own =
        grid.kind == Grid::Kind::kBox
            ? divide_box(bounds, grid.levels)
            : cover_lattice(bounds, grid.voxel_size,
                            has_origin ? std::optional<Point>(grid.origin) : std::nullopt);
    return own == grid;
  } catch (const Error&) {
    return false;  // the scene has no extent, or is too large for this voxel size
  }
}

}  // namespace

SnapCounts stream_snapped(const Scene& scene, const Grid& grid, CutScene* cuts,
                          const SnappedSink& sink, Rule rule, LayerKind layer) {
  const Lattice lattice(grid);
  OpenParts open;
  if (is_solid(rule))
    open = layer == LayerKind::kNone ? OpenParts(scene, grid, rule)
                                     : OpenParts(scene, grid, rule, layer);
  const LatticeBox whole = grid.closed(grid.whole()), selection = grid.closed(grid.selection);
  SnapCounts counts;
  std::vector<LatticeTriangle> snapped;
  counts.scene = scene.stream([&](const TriangleBatch& batch) {
    snapped.clear();
    if (batch.cut != nullptr && cuts == nullptr)
      fail_usage("the material \"" + std::string(batch.material) +
                 "\" is cut out, which OpenVDB cannot judge: choose --judge integer or cgal "
                 "(--no-cutouts judges a bake with it whole)");
    const uint32_t material =
        batch.cut != nullptr ? material_number(*batch.cut, &cuts->cut_outs) : 0;
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      const Triangle& t = batch.triangles[k];
      LatticeTriangle q;
      q.sheet = open.contains(batch);
      double move = 0;
      for (int i = 0; i < 3; ++i) q.v[i] = lattice.snap(t.v[i], &move);
      const LatticeBox box = box_of(q);
      if (box.meets(selection)) counts.largest_move = std::max(counts.largest_move, move);
      const bool meets = whole.meets(box);
      counts.outside += !meets;
      if (!meets && !is_solid(rule)) continue;
      if (batch.cut != nullptr)
        q.cut = add_record({batch.texture[k], material}, &cuts->records) & kMaxCut;
      snapped.push_back(q);
    }
    if (!snapped.empty()) sink(snapped, batch);
  });
  counts.largest_move /= double(int64_t(1) << grid.fraction());
  return counts;
}

std::string snap_defect(double recorded, const SnapCounts& whole_scene) {
  if (recorded == 0 || recorded == whole_scene.largest_move) return {};
  return "the header records a largest snap of " + format_double(recorded) + " voxels, but it is " +
         format_double(whole_scene.largest_move);
}

GridJudgement judge_grid(const Grid& grid, const Box& bounds) {
  GridJudgement judgement;
  judgement.recomputed = follows_from(grid, bounds);
  if (grid.kind != Grid::Kind::kBox) {
    for (int a = 0; a < 3; ++a) {
      const int64_t step = corner_step(grid.levels);
      if (grid.k0[a] % step != 0)
        judgement.defects.push_back("the corner of the grid, plane " + std::to_string(grid.k0[a]) +
                                    ", is not a multiple of " + std::to_string(step));
    }
  }
  if (grid.bounded) return judgement;
  const Lattice lattice(grid);
  const LatticePoint low = lattice.snap(bounds.min), high = lattice.snap(bounds.max);
  for (int a = 0; a < 3; ++a) {
    const int64_t side = grid.resolution() << grid.fraction();
    if (low[a] >= 0 && high[a] <= side) continue;
    const double from = grid.corner()[a];
    const double to = from + double(grid.resolution()) * grid.voxel_size;
    judgement.defects.push_back(std::string("the grid does not hold the scene: on ") + "xyz"[a] +
                                " the scene reaches from " + format_double(bounds.min[a]) + " to " +
                                format_double(bounds.max[a]) + ", the grid from " +
                                format_double(from) + " to " + format_double(to));
  }
  return judgement;
}

}  // namespace svdag
