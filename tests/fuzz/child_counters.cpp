// Shares the coverage counters of a fuzzer with its child processes
// (streaming/process/limited_child.h), so that it sees the coverage of the children.
//
// The compiler stores the counters in separate sections, whose bounds the linker defines. The
// directives below only align the sections to a page, so that sharing begins with the first
// counter; this must be the first linked object. After the last counter, its page continues with
// constants. This file is compiled without counters, whose symbols would clash with its own.
// Rejected:
// __libfuzzer_extra_counters (a child would copy its counters before it ends; a crashed one does
// not).
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

// The counters of libFuzzer, and those of clang's source-based coverage (coverage.py), if present.
asm(".pushsection __sancov_cntrs,\"aw\",@progbits\n.balign 4096\n.popsection");
asm(".pushsection __llvm_prf_cnts,\"aw\",@progbits\n.balign 4096\n.popsection");
extern "C" {
extern uint8_t __start___sancov_cntrs[], __stop___sancov_cntrs[];
extern uint8_t __start___llvm_prf_cnts[], __stop___llvm_prf_cnts[];
}

namespace {

void share_with_children(uint8_t* begin, const uint8_t* end) {
  constexpr size_t kPage = 4096;
  const size_t size = (size_t(end - begin) + kPage - 1) / kPage * kPage;
  if (size == 0) return;
  void* const kept = std::malloc(size);
  std::memcpy(kept, begin, size);
  const int shared = MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED;
  if (::mmap(begin, size, PROT_READ | PROT_WRITE, shared, -1, 0) != begin) std::abort();
  std::memcpy(begin, kept, size);
  std::free(kept);
}

}  // namespace

// Called by libFuzzer before the first input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  share_with_children(__start___sancov_cntrs, __stop___sancov_cntrs);
  share_with_children(__start___llvm_prf_cnts, __stop___llvm_prf_cnts);
  return 0;
}
