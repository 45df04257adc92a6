#include "tests/fuzz/reader_fuzz.h"

namespace svdag {
namespace {

// The first byte chooses the format.
constexpr decltype(&read_fbx) kReaders[] = {read_fbx, read_collada, read_3mf, read_3ds};

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  return svdag::fuzz_reader(svdag::kReaders[data[0] % 4], data + 1, size - 1,
                            svdag::kDecoderMemory);
}
