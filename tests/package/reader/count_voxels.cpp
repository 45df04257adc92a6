// Prints the resolution and the number of set voxels of a .svdag, counted by walking all bricks.
#include <svdag/io/dag/dag_file.h>

#include <cstdio>
#include <exception>

namespace {

uint64_t count(const svdag::DagView& dag, uint32_t level, uint32_t node) {
  if (level == dag.brick_level()) return uint64_t(__builtin_popcountll(dag.bricks[node]));
  uint64_t voxels = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = svdag::dag_child(dag, level, node, c);
    if (child != svdag::kNoChild) voxels += count(dag, level + 1, child);
  }
  return voxels;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: count_voxels FILE.svdag\n", stderr), 2;
  try {
    const svdag::DagFile file = svdag::DagFile::open(argv[1]);
    const svdag::DagView& dag = file.view();
    std::printf("%u %llu\n", dag.resolution(),
                static_cast<unsigned long long>(dag.empty() ? 0 : count(dag, 0, 0)));
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 3;
  }
}
