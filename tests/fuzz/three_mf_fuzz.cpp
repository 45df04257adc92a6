#include "tests/fuzz/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return svdag::fuzz_reader(svdag::read_3mf, data, size, svdag::kDecoderMemory);
}
