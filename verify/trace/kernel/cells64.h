// Computes which of a node's 64 cells a ray meets, all at once, without stepping from cell to cell.
//
// Idea: a cell is met if the latest of begin and its three near planes comes before the earliest of
// end and its three far planes (ray.h). A node has five planes per axis, so fifteen times decide
// all 64 cells. They are compared as bytes, 64 in two vectors:
//
//   byte(t) = 0 .. 254, the whole part of (t - enter) * scale + 1
//
// where `enter` is the time at which the node is entered.
//
// Invariant: no met cell is lost. Rounding is monotone, in the times as in their bytes, so near <
// far gives byte(near) <= byte(far); the byte of any time after `enter` is 1 or more. False
// positives are possible: a cell that is missed by less than 1/63 of a cell's crossing time may be
// reported. Then its own cells are not reported, or the voxel is tested exactly (Walk64::find_hit).
// So hits do not depend on scale, on the order of operations here, or on fused operations.
//
// scale = 63 / (time to cross a cell along the steepest axis): a node is left within 252 units.
//
// Rejected: stepping from cell to cell by the earliest far plane (each step depends on the previous
// one through an unpredictable branch); all comparisons in double (twice as many vectors); times in
// float relative to the node's entry (no faster, and needs error bounds).
//
// For host and CUDA; cells64_avx2.h is the vectorized version.
#pragma once

#include "verify/trace/kernel/ray.h"
#include "verify/trace/kernel/tree64_view.h"

namespace svdag {

// The terms of a ray's plane times. The fourth element of each array is 0.
struct alignas(32) RayTimes {
  double origin[4], inverse[4];
  double begin, end, scale;  // scale: for cells of side 1
  uint32_t flip;             // XORed to cell numbers to mirror them: 9 * MirroredRay::flip

  RayTimes() = default;
  SVDAG_HD RayTimes(const MirroredRay& ray, const Span& span)
      : begin(span.begin), end(span.end), flip(9 * ray.flip) {
    double min_inverse = ray.inverse[0];
    for (int a = 0; a < 3; ++a) {
      origin[a] = ray.origin[a];
      inverse[a] = ray.inverse[a];
      min_inverse = inverse[a] < min_inverse ? inverse[a] : min_inverse;
    }
    origin[3] = inverse[3] = 0;
    scale = 63 / min_inverse;
  }
};

// A node or brick that a ray enters: cell number `cell` of the node with corner `parent`. The root
// is cell 0 of a parent at the origin.
struct Visit {
  const double* parent;  // corner of the parent: aligned, mirrored, the fourth element is 0
  double* corner;        // corner of this node, in the same form; output of of()
  const uint64_t* node;  // its mask
  uint32_t cell;
  uint32_t depth;
};

// The scalar version, for CUDA and as the reference for the vectorized one.
struct PlainCells {
  // The cells that are set and possibly met, in mirrored coordinates. Writes visit.corner.
  SVDAG_HD static uint64_t of(const Tree64View& tree, const RayTimes& ray, const Visit& visit) {
    const double side = tree.side[visit.depth];
    for (int a = 0; a < 3; ++a)
      visit.corner[a] = visit.parent[a] + cell64_at(visit.cell, a) * (4 * side);
    visit.corner[3] = 0;
    return mirrored(ray, *visit.node) & met(ray, visit.corner, side, tree.per_side[visit.depth]);
  }

  // A superset of the met cells of the node at `corner` (mirrored) with cells of side `side`, a
  // power of two; per_side = 1 / side.
  SVDAG_HD static uint64_t met(const RayTimes& ray, const double corner[4], double side,
                               double per_side) {
    double enter = ray.begin;
    for (int a = 0; a < 3; ++a) {
      const double near = time(ray, a, corner[a]);
      enter = near > enter ? near : enter;
    }
    const double scale = ray.scale * per_side;
    const unsigned last = byte_of(ray.end, enter, scale);
    unsigned low[3][4], high[3][4];
    for (int a = 0; a < 3; ++a) {
      unsigned near = byte_of(time(ray, a, corner[a]), enter, scale);
      for (int i = 0; i < 4; ++i) {
        const unsigned far = byte_of(time(ray, a, corner[a] + (i + 1) * side), enter, scale);
        low[a][i] = near > 1 ? near : 1;
        high[a][i] = far < last ? far : last;
        near = far;
      }
    }
    uint64_t cells = ~uint64_t(0);
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      for (unsigned i = 0; i < 4; ++i) {
        for (unsigned j = 0; j < 4; ++j) {
          if (low[a][i] > high[b][j] || low[b][j] > high[a][i])
            cells &= ~(slab64(a, i) & slab64(b, j));
        }
      }
    }
    return cells;
  }

  // Converts a mask of cells from tree coordinates to mirrored ones.
  SVDAG_HD static uint64_t mirrored(const RayTimes& ray, uint64_t cells) {
    for (int a = 0; a < 3; ++a) {
      if (!(ray.flip >> (2 - a) & 1U)) continue;
      const int near = 4 >> a, far = 32 >> a;
      const uint64_t odd = slab64(a, 1) | slab64(a, 3), upper = slab64(a, 2) | slab64(a, 3);
      cells = (cells & odd) >> near | (cells & ~odd) << near;
      cells = (cells & upper) >> far | (cells & ~upper) << far;
    }
    return cells;
  }

 private:
  SVDAG_HD static double time(const RayTimes& ray, int axis, double plane) {
    return (plane - ray.origin[axis]) * ray.inverse[axis];
  }
  SVDAG_HD static unsigned byte_of(double t, double enter, double scale) {
    const double units = (t - enter) * scale + 1;
    return units > 0 ? unsigned(units < 254 ? units : 254) : 0;
  }
};

}  // namespace svdag
