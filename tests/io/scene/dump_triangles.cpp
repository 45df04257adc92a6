// Prints the triangles of a scene file as raw little-endian doubles, nine per triangle, in the
// order of the reader: what the independent Python reader is compared with.
#include <cstdio>

#include "io/scene/scene.h"
#include "streaming/error.h"

int main(int argc, char** argv) {
  if (argc != 2) return int(svdag::ExitCode::kUsage);
  try {
    svdag::MemoryBudget budget;
    const svdag::Scene scene({{argv[1]}, {}, false}, &budget);
    bool written = true;
    scene.stream([&](const svdag::TriangleBatch& batch) {
      const size_t n = batch.triangles.size();
      written = written && std::fwrite(batch.triangles.data(), 9 * sizeof(double), n, stdout) == n;
    });
    return written && std::fflush(stdout) == 0 ? 0 : int(svdag::ExitCode::kOutput);
  } catch (const svdag::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.code());
  }
}
