#include "tests/fuzz/reader_fuzz.h"

namespace svdag {
namespace {

// The first byte chooses the format.
const char* const kFormats[] = {"FBX", "COLLADA", "3MF", "3DS"};
const char* format = kFormats[0];

void read(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  read_with_assimp(file, format, options, sink);
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  svdag::format = svdag::kFormats[data[0] % 4];
  return svdag::fuzz_reader(svdag::read, data + 1, size - 1, svdag::kDecoderMemory);
}
