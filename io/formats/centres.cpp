#include "io/formats/vdb.h"
#include "streaming/error.h"

namespace svdag {

IndexToWorld voxel_centres(const Grid& grid) {
  IndexToWorld centres;
  for (int a = 0; a < 3; ++a) centres.axes[size_t(a)][a] = grid.voxel_size;
  centres.origin = grid.corner() + grid.voxel_size * 0.5;
  return centres;
}

void reject_needless_range(const VdbGrid& grid, const std::optional<ValueRange>& range) {
  if (range && grid.type() != "float")
    fail_usage("--iso: grid " + grid.name() + " is a " + grid.type() +
               " grid, which has no values to select: leave --iso out");
}

// A mask tree takes 114 bytes per leaf and 34 KB or 271 KB per inner node; bool grids and NanoVDB
// take more. Up to three trees exist at once: the filled one, the written one, and the one read
// back. Measured on the dragon at 4K^3 (670,441 leaves): mask 316 MB, NanoVDB 444 MB, bool 542 MB;
// this bound gives 580 MB. The leaves of float trees, the written one and the one read back, also
// hold 512 values each.
uint64_t vdb_bytes(VdbFormat format, uint64_t leaves, uint64_t nodes_of_128,
                   uint64_t nodes_of_4096) {
  const uint64_t values = format == VdbFormat::kFloat ? 2 * 512 * sizeof(float) : 0;
  return 3 * (leaves * 160 + nodes_of_128 * 36'000 + nodes_of_4096 * 280'000) + leaves * values;
}

// The tree that is filled and written, and the one that is read back. A node has a pointer or a
// value for each of its 16^3 or 32^3 children.
uint64_t vdb_value_bytes(size_t value, uint64_t leaves, uint64_t nodes_of_128,
                         uint64_t nodes_of_4096) {
  const uint64_t more = value <= 8 ? 0 : 4096 * 32;  // of 16^3: a value in memory of its own
  return 2 * (leaves * (160 + 512 * value) + nodes_of_128 * (36'000 + more) +
              nodes_of_4096 * (280'000 + 8 * more));
}

}  // namespace svdag
