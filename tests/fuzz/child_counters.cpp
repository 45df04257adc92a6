// Lets a fuzzer see what its children have reached (streaming/process/limited_child.h): the
// counters of coverage are in memory that it shares with them, instead of in pages that fork()
// copies.
//
// The compiler gathers the counters in sections of their own, and the linker says where these begin
// and end. The directives below add nothing but the alignment of a page, so that sharing begins
// with the first counter (this must be the first object that is linked); behind the last one, its
// page continues with constants. No counters of this file itself: its names would clash with those
// that they bring. Rejected: __libfuzzer_extra_counters (a child would have to copy its counters
// before it ends, and one that crashes does not).
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

// libFuzzer's, and those of clang's source-based coverage (coverage.py), if there are any.
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
