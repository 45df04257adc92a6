#include "streaming/progress.h"

#include <unistd.h>

#include <cstdio>

namespace svdag {

Progress::Progress(Mode mode)
    : enabled_(mode == Mode::kOn || (mode == Mode::kAuto && isatty(STDERR_FILENO) == 1)),
      start_(std::chrono::steady_clock::now()) {}

void Progress::phase(const std::string& name, uint64_t total) {
  finish();
  name_ = name;
  total_ = total;
  done_ = 0;
  next_draw_ = 0;
  start_ = std::chrono::steady_clock::now();
  if (enabled_) draw(0);
}

void Progress::advance(uint64_t steps) {
  const uint64_t done = done_.fetch_add(steps, std::memory_order_relaxed) + steps;
  if (!enabled_) return;
  const int64_t now = std::chrono::duration_cast<std::chrono::milliseconds>(
                          std::chrono::steady_clock::now() - start_)
                          .count();
  int64_t due = next_draw_.load(std::memory_order_relaxed);
  // Whoever moves the deadline draws: one thread at a time, without a lock.
  if (now >= due && next_draw_.compare_exchange_strong(due, now + 100)) draw(done);
}

void Progress::draw(uint64_t done) {
  drawn_ = true;
  if (total_ > 0) {
    std::fprintf(stderr, "\r\033[K%s %3.0f %%", name_.c_str(),
                 100.0 * double(done) / double(total_));
  } else if (done > 0) {
    std::fprintf(stderr, "\r\033[K%s %llu", name_.c_str(), static_cast<unsigned long long>(done));
  } else {
    std::fprintf(stderr, "\r\033[K%s", name_.c_str());
  }
  std::fflush(stderr);
}

void Progress::finish() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace svdag
