// Arbitrary bytes as a .vdb of a mask or of values: OpenVDB reads them in a child process, and
// whatever it sends or dies of is a grid or an Error.
#include "io/formats/vdb.h"
#include "tests/fuzz/import_fuzz.h"

namespace svdag {
namespace {

// Values around a level set; a mask has none and is taken as it is.
constexpr ValueRange kRange = {-0.5, 0.5};

void visit(const VdbGrid& grid) {
  size_t visited = 0;
  grid.visit([&](const Cube& cube) {
    if (cube.side < kBlockSide || (cube.side == kBlockSide && cube.block.empty())) std::abort();
    return ++visited < kMostVisited;
  });
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  try {
    visit(*read_vdb(memory.file().path(), "", kRange));
  } catch (const Error& error) {
    if (error.code() != ExitCode::kUsage) expect_bad_input(error);  // one of many grids, a range
  }
  return 0;
}
