#include "streaming/process/call_filter.h"

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <vector>

namespace svdag {
namespace {

#if defined(__x86_64__)
constexpr uint32_t kProcessor = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr uint32_t kProcessor = AUDIT_ARCH_AARCH64;
#else
constexpr uint32_t kProcessor = 0;
#endif

constexpr long kAllowed[] = {
    SYS_read,           SYS_write,       SYS_mmap,          SYS_munmap,
    SYS_mremap,         SYS_mprotect,    SYS_madvise,       SYS_brk,
    SYS_futex,          SYS_sched_yield, SYS_rt_sigaction,  SYS_rt_sigreturn,
    SYS_rt_sigprocmask, SYS_close,       SYS_clock_gettime, SYS_lseek,
    SYS_fstat,          SYS_exit,        SYS_exit_group};
// These fail with EPERM. Calls of abort(), which so still ends the process with a crash; and the one with which free()
// of glibc asks whether it may shrink a heap.
constexpr long kFailing[] = {SYS_getpid, SYS_gettid, SYS_tgkill, SYS_openat};

using Program = std::vector<sock_filter>;

void emit_load(uint32_t offset, Program* out) {
  out->push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offset));
}
void emit_return(uint32_t action, Program* out) {
  out->push_back(BPF_STMT(BPF_RET | BPF_K, action));
}
void emit_return_if_equal(uint32_t value, uint32_t action, Program* out) {
  out->push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1));
  emit_return(action, out);
}

}  // namespace

bool install_call_filter() {
  if (kProcessor == 0) return false;
  Program program;
  emit_load(offsetof(seccomp_data, arch), &program);
  program.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kProcessor, 1, 0));
  emit_return(SECCOMP_RET_KILL_PROCESS, &program);
  emit_load(offsetof(seccomp_data, nr), &program);
  for (const long call : kAllowed)
    emit_return_if_equal(uint32_t(call), SECCOMP_RET_ALLOW, &program);
  for (const long call : kFailing)
    emit_return_if_equal(uint32_t(call), SECCOMP_RET_ERRNO | EPERM, &program);
  emit_return(SECCOMP_RET_KILL_PROCESS, &program);
  const sock_fprog filter = {static_cast<unsigned short>(program.size()), program.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

}  // namespace svdag
