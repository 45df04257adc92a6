// The view alone, without any library: counts the voxels of a file, asking for every brick.
#include <svdag/io/dag/dag_view.h>

#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  std::FILE* file = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr) return std::fputs("usage: mapped FILE.svdag\n", stderr), 2;
  std::fseek(file, 0, SEEK_END);
  std::vector<unsigned long long> bytes(size_t(std::ftell(file)) / 8 + 1);  // aligned for the view
  std::rewind(file);
  const size_t read = std::fread(bytes.data(), 1, bytes.size() * 8, file);
  std::fclose(file);
  const auto view = svdag::dag_view(bytes.data(), read);
  if (!view) return std::fprintf(stderr, "%s\n", svdag::dag_defect(bytes.data(), read)), 3;
  const svdag::DagView& dag = *view;
  const uint32_t bricks = dag.resolution() / 4;
  unsigned long long voxels = 0;
  for (uint32_t x = 0; x < bricks; ++x) {
    for (uint32_t y = 0; y < bricks; ++y) {
      for (uint32_t z = 0; z < bricks; ++z)
        voxels += unsigned(__builtin_popcountll(svdag::dag_brick(dag, x, y, z)));
    }
  }
  std::printf("%u %llu\n", dag.resolution(), voxels);
}
