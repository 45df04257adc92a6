// Casts one ray, in world coordinates, and prints the voxel that it meets first.
//
//   cast_ray FILE.svdag X Y Z DX DY DZ
#include <svdag/io/dag/dag_file.h>
#include <svdag/verify/trace/kernel/traverse.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) {
  if (argc != 8) {
    std::fputs("usage: cast_ray FILE.svdag X Y Z DX DY DZ\n", stderr);
    return 2;
  }
  svdag::Vec3 origin, direction;
  for (int a = 0; a < 3; ++a) {
    origin[a] = std::atof(argv[2 + a]);
    direction[a] = std::atof(argv[5 + a]);
  }
  try {
    const svdag::DagFile file = svdag::DagFile::open(argv[1]);  // checked, then mapped
    const svdag::DagView& dag = file.view();
    const svdag::Ray ray = svdag::ray_from_world(dag, origin, direction);
    const svdag::Hit hit = svdag::trace_closest(dag, ray);
    if (!hit.found) {
      std::puts("no voxel");
      return 0;
    }
    std::printf("voxel %u %u %u at t = %g, point", hit.voxel[0], hit.voxel[1], hit.voxel[2], hit.t);
    for (int a = 0; a < 3; ++a) std::printf(" %g", origin[a] + hit.t * direction[a]);
    std::printf("\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
