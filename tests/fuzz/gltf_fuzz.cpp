#include "tests/fuzz/reader_fuzz.h"

// At rest, and at a time of its animations.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const svdag::PoseTime time{0.5};
  svdag::fuzz_reader(svdag::read_gltf, data, size, svdag::kDecoderMemory);
  return svdag::fuzz_reader(svdag::read_gltf, data, size, svdag::kDecoderMemory, &time);
}
