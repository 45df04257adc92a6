#include "builder/colours/part_walker.h"

#include <algorithm>
#include <bit>

#include "builder/octree/morton.h"
#include "builder/overlap/exact_voxel.h"
#include "builder/overlap/kernels/divide_list.h"

namespace svdag {
namespace {

// Whether the closed triangle meets the closed cube.
bool meets_cube(const TriangleSetup& t, const LatticePoint& corner, int side_log2) {
  if (!t.box.meets({corner, corner + (int64_t(1) << side_log2)})) return false;
  if (!voxel_meets_plane(t, corner, side_log2, 0)) return false;
  for (int k = 0; k < 9; ++k) {
    if ((t.edges >> k & 1) && !column_reaches(t, k, corner, side_log2, 0)) return false;
  }
  return true;
}

}  // namespace

PartWalker::PartWalker(const DagView& dag, const Grid& grid, Rule rule, int level,
                       UntouchedNodes* untouched)
    : dag_(dag),
      levels_(grid.levels),
      is_solid_(is_solid(rule)),
      level_(level),
      untouched_(untouched),
      lists_(size_t(level) + 1) {}

void PartWalker::walk(const PreparedTriangles& triangles, Part* part) {
  triangles_ = &triangles;
  out_ = &part->colours;
  visit(part->node, part->list);
}

void PartWalker::add(const PreparedTriangles& triangles, const Cube& cube, const TriangleList& list,
                     bool nearest, CubeSum* sum) {
  const LatticePoint corner = cube.corner(levels_);
  counts_.pairs += list.size();
  members_.clear();
  for (const ListedTriangle& entry : list) {
    const size_t i = triangles.index_of(entry);
    const CubeShare share = triangles.shares[i].share_in(corner);
    const bool surely = share.area >= kSurelyMeets && !entry.triangle->wide;
    if (!surely && !meets_cube(*entry.triangle, corner, cube.side_log2(levels_))) continue;
    sum->add(share, triangles.one_colours[i] != PreparedTriangles::kVarying);
    members_.push_back(i);
  }
  if (sum->has_area() && !nearest) return;
  for (const size_t i : members_) sum->add_nearest(triangles.shares[i].nearest_to_centre(corner));
}

void PartWalker::end_cube(const CoveredNode& node, const CubeSum& sum,
                          std::vector<CubeColour>* out) {
  if (sum.empty()) return untouched_->add(node, out);
  counts_.cubes_by_points += !sum.has_area();
  out->push_back(sum.colour(morton(node.cube.coordinate), level_));
}

bool PartWalker::ends(const PreparedTriangles& triangles, const CoveredNode& node,
                      const TriangleList& list, std::vector<CubeColour>* out) {
  if (list.empty()) return untouched_->add(node, out), true;
  if (is_solid_ || node.cube.level < std::min(kComparedLevel, level_ - 1) ||
      node.cube.level == level_)
    return false;
  const uint64_t colour = triangles.one_colour_of(list);
  if (colour == PreparedTriangles::kVarying) return false;
  out->push_back({morton(node.cube.coordinate),
                  uint8_t(node.cube.level),
                  true,
                  true,
                  {uint16_t(colour >> 32), uint16_t(colour >> 16), uint16_t(colour)}});
  return true;
}

void PartWalker::visit(const CoveredNode& node, const TriangleList& list) {
  if (ends(*triangles_, node, list, out_)) return;
  if (node.cube.level == level_) {
    CubeSum sum;
    add(*triangles_, node.cube, list, false, &sum);
    return end_cube(node, sum, out_);
  }
  std::array<TriangleList, 8>& children = lists_[size_t(node.cube.level)];
  divide_list(list, node.cube, levels_, {}, &children);
  const size_t first = out_->size();
  for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1) {
    const unsigned c = unsigned(std::countr_zero(mask));
    visit(covered_child(dag_, node, c), children[c]);
  }
  join(node, first);
}

void PartWalker::join(const CoveredNode& node, size_t first) {
  const auto same = [&](const CubeColour& entry) {
    return entry.is_constant && entry.level == node.cube.level + 1 &&
           std::ranges::equal(entry.linear, (*out_)[first].linear);
  };
  if (out_->size() == first || !std::all_of(out_->begin() + long(first), out_->end(), same)) return;
  (*out_)[first].morton = morton(node.cube.coordinate);
  (*out_)[first].level = uint8_t(node.cube.level);
  out_->resize(first + 1);
}

}  // namespace svdag
