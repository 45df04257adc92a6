#include "tests/fuzz/reader_fuzz.h"

namespace svdag {
namespace {

// The first byte chooses the format.
constexpr MeshReader kReaders[] = {read_3ds, read_collada};

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  return svdag::fuzz_reader(svdag::kReaders[data[0] % 2], data + 1, size - 1,
                            svdag::kDecoderMemory);
}
