// Cut-out triangles in the lists of the descent (io/scene/cutouts/cut_triangle.h decides).
#include <algorithm>
#include <bit>
#include <cmath>

#include "builder/descend/descend.h"
#include "builder/descend/rules.h"
#include "io/scene/cutouts/cut_triangle.h"

namespace svdag {

// The same triangle, not cut.
const TriangleSetup* Descent::whole(const TriangleSetup* triangle) {
  std::unique_ptr<TriangleSetup>& copy = whole_[triangle];
  if (!copy) {
    copy = std::make_unique<TriangleSetup>(*triangle);
    copy->triangle.cut = 0;
  }
  return copy.get();
}

const CutPlane& Descent::cut_plane(const TriangleSetup* triangle) {
  KnownCut& known = known_cuts_[size_t(triangle->triangle.cut) % known_cuts_.size()];
  if (known.triangle != triangle) {
    const LatticeTriangle& t = triangle->triangle;
    const CutRecord& record = (*cuts_)[t.cut - 1];
    known.triangle = triangle;
    known.plane.emplace((*config_.cut_outs)[record.material], CutTriangle{t, record.corners},
                        int64_t(1) << grid_.fraction());
  }
  return *known.plane;
}

void Descent::settle_cuts(const Cube& cube, TriangleList* list) {
  const LatticePoint corner = cube.corner(grid_.levels);
  const int64_t side = int64_t(1) << cube.side_log2(grid_.levels);
  const int64_t cell = int64_t(std::ldexp(cell_side_, grid_.fraction()));
  std::erase_if(*list, [&](ListedTriangle& entry) {
    if (entry.triangle->triangle.cut == 0) return false;
    // In a cube larger than the triangle, it is what it was in the cell.
    if (side != cell && entry.triangle->extent < double(side)) return false;
    const Opacity opacity = cut_plane(entry.triangle).in_cube(corner, side);
    if (opacity == Opacity::kOpaque) entry.triangle = whole(entry.triangle);
    return opacity == Opacity::kTransparent;
  });
}

// The voxels of `wanted` in the brick at `corner` that a triangle sets.
Brick Descent::opaque_voxels(const ListedTriangle& entry, const LatticePoint& corner,
                             Brick wanted) {
  const Brick touched =
      voxels_.brick(&entry, 1, corner, grid_.fraction(), wanted, &counts_.decisions);
  const LatticeTriangle& t = entry.triangle->triangle;
  if (t.cut == 0) return touched;
  const CutRecord& record = (*cuts_)[t.cut - 1];
  const CutOut& cut = (*config_.cut_outs)[record.material];
  const int64_t voxel = int64_t(1) << grid_.fraction();
  const bool thin = config_.rule == Rule::kThin;
  const CutPlane& plane = cut_plane(entry.triangle);
  Brick opaque = 0;
  for (Brick left = touched; left != 0; left &= left - 1) {
    const unsigned bit = unsigned(std::countr_zero(left));
    const auto [x, y, z] = brick_voxel(bit);
    const LatticePoint at = corner + LatticePoint(x, y, z) * voxel;
    const Opacity opacity = thin ? plane.in_cube(at, voxel) : plane.any_in_cube(at, voxel);
    if (opacity == Opacity::kOpaque ||
        (opacity == Opacity::kMixed &&
         is_opaque_in_voxel(cut, {t, record.corners}, at, voxel, thin)))
      opaque |= Brick(1) << bit;
  }
  return opaque;
}

}  // namespace svdag
