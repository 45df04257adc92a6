// Prints every set voxel of a small `.svdag` as "x y z", found with dag_voxel(), for
// reader_test.py.
#include <cstdio>

#include "io/dag/dag_file.h"
#include "streaming/error.h"

namespace {

void print_brick(const svdag::DagView& dag, uint32_t x, uint32_t y, uint32_t z) {
  for (uint32_t i = 0; i < 64; ++i) {
    const uint32_t vx = x + i / 16, vy = y + i / 4 % 4, vz = z + i % 4;
    if (svdag::dag_voxel(dag, vx, vy, vz)) std::printf("%u %u %u\n", vx, vy, vz);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return int(svdag::ExitCode::kUsage);
  try {
    const svdag::DagFile file = svdag::DagFile::open(argv[1]);
    const svdag::DagView& dag = file.view();
    const uint32_t bricks = dag.resolution() / 4;
    for (uint32_t x = 0; x < bricks; ++x) {
      for (uint32_t y = 0; y < bricks; ++y) {
        for (uint32_t z = 0; z < bricks; ++z) {
          if (svdag::dag_brick(dag, x, y, z) != 0) print_brick(dag, 4 * x, 4 * y, 4 * z);
        }
      }
    }
    return 0;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
