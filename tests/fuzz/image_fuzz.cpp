#include "io/scene/colours/linear_images.h"

#include <span>

#include "tests/fuzz/file_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  MemoryBudget budget(uint64_t(64) << 20);
  expect_only_errors([&] {
    LinearImages images(&budget, false, LinearImages::Detail::kThumbnails);
    images.image("image", 1, [&](MemoryBudget::Reservation*) {
      const auto bytes = std::as_bytes(std::span(data, size));
      return std::vector<std::byte>(bytes.begin(), bytes.end());
    });
  });
  if (budget.used() != 0) std::abort();
  return 0;
}
