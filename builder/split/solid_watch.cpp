#include "builder/split/solid_watch.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "builder/split/open_edges.h"
#include "io/lattice.h"
#include "streaming/error.h"

namespace svdag {
namespace {

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

void require_closed(const Scene& scene, const Grid& grid, Rule rule, const EdgeSum& edges,
                    bool are_frames) {
  if (is_closed(edges, rule) || is_closed(boundary_chain(scene, grid), rule)) return;
  const OpenEdges open = find_open_edges(scene, grid);
  throw Error(
      ExitCode::kBadInput,
      open.closed_mod_2
          ? "the triangles of the scene are not oriented alike at " + describe(open) +
                ": give --inside odd"
          : "the scene is not closed: " + describe(open) + ": repair it" +
                (are_frames ? "" : ", or bake its open parts as surfaces with --open surface"));
}

}  // namespace

SolidWatch::SolidWatch(const Scene& scene, const Grid& grid, const ContentOptions& options,
                       MemoryBudget* budget)
    : scene_(scene),
      grid_(grid),
      rule_(options.rule),
      are_frames_(options.layers == LayerKind::kFrame),
      windings_(std::make_shared<CellWindings>(grid.levels, Cube(),
                                               CellWindings::level_of_grid(grid.levels), budget)) {
  if (options.open_as_sheets) open_parts_ = OpenParts(scene, grid, rule_);
  if (options.layers != LayerKind::kNone)
    open_layers_ = OpenParts(scene, grid, rule_, options.layers);
}

uint32_t SolidWatch::sheet_of(const TriangleBatch& batch) const {
  return (open_parts_.contains(batch) ? kSheetOfUnion : 0) |
         (open_layers_.contains(batch) ? kSheetOfLayer : 0);
}

void SolidWatch::add(const LatticeTriangle& triangle) {
  windings_->add_with_ray(triangle);
  if ((triangle.sheet & kSheetOfUnion) != 0) return;
  edges_.add(triangle);
  volume_ += volume_of(triangle, grid_.fraction());
}

std::shared_ptr<const CellWindings> SolidWatch::finish() {
  // With open parts, finding them has tested the others.
  if (open_parts_.size() == 0) require_closed(scene_, grid_, rule_, edges_, are_frames_);
  // Open edges of two frames may cancel each other.
  if (are_frames_ && open_layers_.size() != 0)
    throw Error(ExitCode::kBadInput, "the scene is not closed at " +
                                         std::to_string(open_layers_.size()) +
                                         " of its frames: repair it");
  windings_->finish();
  return std::move(windings_);
}

}  // namespace svdag
