#include "io/formats/dags/hashdag.h"
#include "tests/fuzz/import_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return svdag::fuzz_graph(svdag::read_hashdag, data, size);
}
