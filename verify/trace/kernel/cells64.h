// Computes which of a node's 64 cells a ray meets, all at once, without stepping from cell to cell.
//
// Idea: a cell is met if the latest of begin and its three near planes comes before the earliest of
// end and its three far planes (ray.h). A node has five planes per axis, so fifteen times say it
// for all 64 cells. They are compared as bytes, 64 in two vectors:
//
//   byte(t) = 0 .. 254, the whole part of (t - enter) * scale + 1
//
// where `enter` is the time at which the node is entered.
//
// Invariant: no met cell is lost. Rounding is monotone, in the times as in their bytes, so near <
// far gives byte(near) <= byte(far); the byte of any time after `enter` is 1 or more. The test is
// less sharp: a cell that is missed by less than a 63rd of a step may be reported. Its own cells
// will not be, or the voxel is tested exactly (Walk64::find); so results do not depend on scale, on
// the order of operations here, or on fused ones.
//
// scale = 63 / (time to cross a cell along the steepest axis): a node is left within 252 units.
//
// Rejected: cell after cell by the earliest far plane (each waits for the one before, and the
// processor guesses which it will be); all comparisons in double (twice as many vectors); times in
// float from the node's entry (no faster, and needs bounds on what it loses).
//
// For host and CUDA; cells64_avx2.h is the same in vectors.
#pragma once

#include "verify/trace/kernel/ray.h"
#include "verify/trace/kernel/tree64_view.h"

namespace svdag {

// A ray as its nodes ask for it. The fourth of each four is 0.
struct alignas(32) RayTimes {
  double origin[4], inverse[4];
  double begin, end, scale;  // scale: for cells of side 1
  uint32_t flip;             // of a cell's number in a node: 9 * that of a child

  RayTimes() = default;
  SVDAG_HD RayTimes(const MirroredRay& ray, const Span& span)
      : begin(span.begin), end(span.end), flip(9 * ray.flip) {
    double least = ray.inverse[0];
    for (int a = 0; a < 3; ++a) {
      origin[a] = ray.origin[a];
      inverse[a] = ray.inverse[a];
      least = inverse[a] < least ? inverse[a] : least;
    }
    origin[3] = inverse[3] = 0;
    scale = 63 / least;
  }
};

// A node, or brick, that a ray enters: cell `cell` of the node whose corner is `parent`. Of the
// root itself, cell 0 at 0.
struct Visit {
  const double* parent;  // aligned corners, mirrored; the fourth of each four is 0
  double* corner;        // its own: to be filled in
  const uint64_t* node;  // its mask
  uint32_t cell;
  uint32_t depth;
};

// One number after the other: for CUDA, and what the vectors are tested beside.
struct PlainCells {
  // What is set and perhaps met. Fills in the corner.
  SVDAG_HD static uint64_t of(const Tree64View& tree, const RayTimes& ray, const Visit& visit) {
    const double side = tree.side[visit.depth];
    for (int a = 0; a < 3; ++a)
      visit.corner[a] = visit.parent[a] + cell64_at(visit.cell, a) * (4 * side);
    visit.corner[3] = 0;
    return mirrored(ray, *visit.node) & met(ray, visit.corner, side, tree.per_side[visit.depth]);
  }

  // The cells that are met, and perhaps some more, of the node at `corner` (mirrored) whose cells
  // have side `side`, a power of two; per_side = 1 / side.
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

  // `cells` of a node as in the tree, in mirrored coordinates.
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
