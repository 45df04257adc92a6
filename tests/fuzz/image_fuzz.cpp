#include "io/scene/decoders/image.h"

#include <span>

#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  MemoryBudget budget(uint64_t(64) << 20);
  expect_only_errors([&] {
    mean_of_image({std::as_bytes(std::span(data, size)), "image"}, &budget);
  });
  if (budget.used() != 0) std::abort();
  return 0;
}
