// Arbitrary bytes as a packed file: an Error, or the plain file of its header.

#include "io/dag/pack/unpack.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/fuzz/own_folder.h"
#include "tests/repair_packed.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  static OwnFolder folder;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  repair_packed(&bytes);
  const MemoryFile memory(bytes);
  MemoryBudget budget(64 << 20);
  SequentialExecutor executor;
  expect_only_errors([&] { unpack(memory.file().path(), {&budget, folder.path()}, &executor); });
  return 0;
}
