#include "io/formats/voxels/npz.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto read = [](const svdag::File& file, const svdag::VoxelSink& sink,
                       svdag::LayerTable* layers) {
    return svdag::read_npz(file, sink, layers, /*with_colours=*/true);
  };
  return svdag::fuzz_voxels(read, data, size);
}
