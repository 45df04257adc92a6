// Snaps positions, for snap_vs_fractions.py. Input lines:
// "box|lattice|origin L SIZE  ORIGIN|K0 (3)  POSITION (3)", with numbers as "%a"; an origin has k0
// = 1024. Prints "q q q", or "far" for a position that is rejected.
#include <cstdio>
#include <cstring>

#include "io/lattice.h"
#include "streaming/error.h"

int main() {
  using namespace svdag;
  char kind[16];
  Grid grid;
  Point from, p;
  while (std::scanf("%15s %d %la %la %la %la %la %la %la", kind, &grid.levels, &grid.voxel_size,
                    &from.x, &from.y, &from.z, &p.x, &p.y, &p.z) == 9) {
    const bool lattice = std::strcmp(kind, "lattice") == 0;
    const bool origin = std::strcmp(kind, "origin") == 0;
    grid.kind = lattice ? Grid::Kind::kLattice : origin ? Grid::Kind::kOrigin : Grid::Kind::kBox;
    grid.origin = lattice ? Point(0) : from;
    grid.k0 = lattice ? LatticePoint(from) : LatticePoint(origin ? 1024 : 0);
    try {
      const LatticePoint q = Lattice(grid).snap(p);
      std::printf("%lld %lld %lld\n", static_cast<long long>(q.x), static_cast<long long>(q.y),
                  static_cast<long long>(q.z));
    } catch (const Error&) {
      std::puts("far");
    }
  }
}
