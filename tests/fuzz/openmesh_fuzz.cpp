// Arbitrary bytes as an OpenMesh file: an Error or triangles, within a small budget.
#include "tests/fuzz/memory_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  svdag::read_from_memory(svdag::read_openmesh, data, size);
  return 0;
}
