// Prints every set voxel of a small `.svdag` as "x y z", ascending, by asking dag_voxel() for each:
// the other side of the comparison in reader_test.py.
#include <cstdio>

#include "io/dag/dag_file.h"
#include "streaming/error.h"

int main(int argc, char** argv) {
  if (argc != 2) return int(svdag::ExitCode::kUsage);
  try {
    const svdag::DagFile file = svdag::DagFile::open(argv[1]);
    const uint32_t n = file.view().resolution();
    for (uint32_t x = 0; x < n; ++x) {
      for (uint32_t y = 0; y < n; ++y) {
        for (uint32_t z = 0; z < n; ++z) {
          if (svdag::dag_voxel(file.view(), x, y, z)) std::printf("%u %u %u\n", x, y, z);
        }
      }
    }
    return 0;
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
