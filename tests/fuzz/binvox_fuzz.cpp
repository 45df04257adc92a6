#include "io/formats/voxels/binvox.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return svdag::fuzz_voxels([](const svdag::File& file, const svdag::VoxelSink& sink,
                               svdag::LayerTable*) { return svdag::read_binvox(file, sink); },
                            data, size);
}
