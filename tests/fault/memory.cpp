// A library for LD_PRELOAD: the k-th allocation after main() has begun fails (plan.h: kind
// "alloc").
//
// Allocations of the C library through malloc count too. The code here may allocate only by the
// internal names of libc.
#include <dlfcn.h>
#include <sys/mman.h>

#include <cerrno>

#include "tests/fault/plan.h"

extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t n, size_t size);
void* __libc_realloc(void* block, size_t size);
void* __libc_memalign(size_t alignment, size_t size);
}

namespace {

using Main = int (*)(int, char**, char**);

Main program = nullptr;
std::atomic<bool> begun{false};

bool refused() {
  if (!begun.load(std::memory_order_relaxed) || fault::own_requests > 0) return false;
  const fault::OwnRequests own;
  const int error = fault::strike(fault::kAlloc, "memory");
  if (error > 0) errno = ENOMEM;
  return error > 0;
}

int begin_main(int count, char** arguments, char** environment) {
  fault::plan();
  begun = true;
  const int result = program(count, arguments, environment);
  begun = false;
  return result;
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int count, char** arguments, void (*init)(), void (*fini)(),
                      void (*loader_fini)(), void* stack_end) {
  const auto next = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, __func__));
  program = main;
  return next(begin_main, count, arguments, init, fini, loader_fini, stack_end);
}

void* malloc(size_t size) noexcept {
  return refused() ? nullptr : __libc_malloc(size);
}
void* calloc(size_t n, size_t size) noexcept {
  return refused() ? nullptr : __libc_calloc(n, size);
}
void* realloc(void* block, size_t size) noexcept {
  return refused() ? nullptr : __libc_realloc(block, size);
}
void* memalign(size_t alignment, size_t size) noexcept {
  return refused() ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** block, size_t alignment, size_t size) noexcept {
  void* const made = memalign(alignment, size);
  if (made != nullptr) *block = made;
  return made != nullptr ? 0 : ENOMEM;
}
void* mmap(void* at, size_t size, int protection, int flags, int fd, off_t offset) noexcept {
  if ((flags & MAP_ANONYMOUS) != 0 && refused()) return MAP_FAILED;
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, protection, flags, fd, offset));
}
void* mmap64(void* at, size_t size, int protection, int flags, int fd, off_t offset) noexcept {
  return mmap(at, size, protection, flags, fd, offset);
}

}  // extern "C"
