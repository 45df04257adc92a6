#include "streaming/process/interrupt.h"

#include <signal.h>

#include <atomic>

namespace svdag {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

std::atomic<int> arrived{0};
static_assert(std::atomic<int>::is_always_lock_free);  // required in a signal handler

// Restores the default action of all caught signals: a second one of any kind ends the process.
extern "C" void note_signal(int number) {
  arrived.store(number, std::memory_order_relaxed);
  for (const int each : kSignals) {
    struct sigaction now;
    if (sigaction(each, nullptr, &now) == 0 && now.sa_handler == note_signal)
      ::signal(each, SIG_DFL);
  }
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_signal;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  for (const int each : kSignals) {
    struct sigaction before;
    // Ignored signals stay ignored: nohup, background jobs of a script.
    if (sigaction(each, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaction(each, &action, nullptr);
  }
}

void check_interrupt() {
  const int number = arrived.load(std::memory_order_relaxed);
  if (number != 0) throw Interrupted{number};
}

void pretend_interrupt(int signal) {
  arrived.store(signal, std::memory_order_relaxed);
}

}  // namespace svdag
