#include "io/scene/decoders/gzip.h"

#include "io/scene/mesh/mesh_reader.h"
#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  expect_only_errors([&] {
    File unpacked = create_unpacked("unpacked", nullptr);
    unpack_gzip(memory.file(), &unpacked);
  });
  return 0;
}
