// Arbitrary bytes as a .vdb of masks or of values: OpenVDB reads them in a child process, and
// its output or crash gives a grid or an Error.
#include "io/formats/vdb.h"
#include "tests/fuzz/import_fuzz.h"

namespace svdag {
namespace {

// The values around a level set; a mask has no values.
constexpr ValueRange kRange = {-0.5, 0.5};

void visit(const VdbGrid& grid) {
  size_t visited = 0;
  grid.visit([&](const VoxelCube& cube) {
    if (cube.side < kBlockSide || cube.count() == 0) std::abort();
    const Block& block = cube.block;
    const bool set = cube.side > kBlockSide || block.get(0, 0, 0);
    if (grid.get(cube.origin) != set) std::abort();
    return ++visited < kMaxVisited;
  });
}

}  // namespace
}  // namespace svdag

// Reads the only grid, or the grid "b" if the number of bytes is odd.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  try {
    visit(*read_vdb(memory.file().path(), size % 2 == 1 ? "b" : "", kRange));
  } catch (const Error& error) {
    if (error.code() != ExitCode::kUsage) expect_bad_input(error);  // one of many grids, a range
  }
  return 0;
}
