#include "io/formats/voxels/vox.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return svdag::fuzz_voxels(svdag::read_vox, data, size);
}
