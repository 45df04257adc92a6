#include "io/formats/voxels/npz.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return svdag::fuzz_voxels(svdag::read_npz, data, size);
}
