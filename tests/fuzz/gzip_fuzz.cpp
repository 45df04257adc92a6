#include "io/scene/readers/gzip.h"

#include <filesystem>

#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::string folder = std::filesystem::temp_directory_path();
  const svdag::MemoryFile memory(std::as_bytes(std::span(data, size)));
  svdag::expect_only_errors([&] { svdag::unpack_gzip(memory.file(), folder); });
  return 0;
}
