#include "streaming/process/progress.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "streaming/process/terminal.h"

namespace svdag {

Progress::Progress(Mode mode)
    : enabled_(mode == Mode::kOn || (mode == Mode::kAuto && can_redraw(stderr))),
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
  // The thread that advances the deadline draws, unless another one still does: a terminal may
  // block for longer than the interval.
  if (now < due || !next_draw_.compare_exchange_strong(due, now + 100)) return;
  if (drawing_.test_and_set(std::memory_order_acquire)) return;
  draw(done);
  drawing_.clear(std::memory_order_release);
}

void Progress::draw(uint64_t done) {
  char count[32] = "";
  if (total_ > 0)
    std::snprintf(count, sizeof count, " %3.0f %%", 100.0 * share(done));
  else if (done > 0)
    std::snprintf(count, sizeof count, " %llu", static_cast<unsigned long long>(done));
  // The last column stays free, since some terminals wrap when it is written. The name is truncated
  // before the count.
  const size_t columns = line_width(stderr) - 1;
  const size_t count_columns = std::min(std::strlen(count), columns);
  show(name_.substr(0, columns - count_columns) + std::string(count, count_columns));
}

void Progress::show(std::string line) {
  const size_t columns = line.size();
  if (drawn_ > columns) line += std::string(drawn_ - columns, ' ');
  std::fprintf(stderr, "\r%s", line.c_str());
  std::fflush(stderr);
  drawn_ = columns;
}

void Progress::finish() {
  if (drawn_ == 0) return;
  show("");
  std::fputc('\r', stderr);
}

}  // namespace svdag
