#include "streaming/process/progress.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "streaming/process/terminal.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// 0:43, or 1:02:43.
std::string clock_text(double seconds) {
  const auto all = static_cast<unsigned long long>(seconds + 0.5);
  char text[32];
  if (all < 3600)
    std::snprintf(text, sizeof text, "%llu:%02llu", all / 60, all % 60);
  else
    std::snprintf(text, sizeof text, "%llu:%02llu:%02llu", all / 3600, all / 60 % 60, all % 60);
  return text;
}

// Three digits and a prefix: 18.2M, 312 Mi.
std::string scaled(double value, double base, const char* const (&prefixes)[5]) {
  size_t p = 0;
  for (; p < 4 && value >= 999.5; ++p) value /= base;
  char text[32];
  std::snprintf(text, sizeof text, p == 0 ? "%.0f%s" : "%.3g%s", value, prefixes[p]);
  return text;
}

std::string rate_text(double per_second, const std::string& unit) {
  return scaled(per_second, 1000, {"", "k", "M", "G", "T"}) + " " + unit + "/s";
}

std::string memory_text(uint64_t bytes) {
  return scaled(double(bytes), 1024, {" B", " KiB", " MiB", " GiB", " TiB"});
}

constexpr double kMinShare = 0.02;   // of the work, from which the rest is estimated
constexpr double kMinSeconds = 1.0;  // of a phase, from which a rate is shown

}  // namespace

Progress::Progress(Mode mode)
    : enabled_(mode == Mode::kOn || (mode == Mode::kAuto && can_redraw(stderr))),
      start_(Clock::now()),
      phase_start_(start_) {}

void Progress::phase(const std::string& name, uint64_t total, const std::string& unit) {
  finish();
  name_ = name;
  unit_ = unit;
  total_ = total;
  done_ = items_ = 0;
  next_draw_ = 0;
  phase_start_ = Clock::now();
  if (enabled_) draw(0);
}

void Progress::advance(uint64_t steps, uint64_t items) {
  if (items != 0) items_.fetch_add(items, std::memory_order_relaxed);
  const uint64_t done = done_.fetch_add(steps, std::memory_order_relaxed) + steps;
  if (!enabled_) return;
  const int64_t now = int64_t(1e3 * seconds_since(phase_start_));
  int64_t due = next_draw_.load(std::memory_order_relaxed);
  // The thread that advances the deadline draws, unless another one still does: a terminal may
  // block for longer than the interval.
  if (now < due || !next_draw_.compare_exchange_strong(due, now + 100)) return;
  if (drawing_.test_and_set(std::memory_order_acquire)) return;
  draw(done);
  drawing_.clear(std::memory_order_release);
}

void Progress::draw(uint64_t done) {
  const bool in_interval = size_ < 1;
  char count[32] = "";
  if (total_ > 0 || in_interval)
    std::snprintf(count, sizeof count, " %3.0f %%", 100.0 * share(done));
  else if (done > 0)
    std::snprintf(count, sizeof count, " %llu", static_cast<unsigned long long>(done));
  // The last column stays free, since some terminals wrap when it is written. The name is truncated
  // before the count.
  const size_t columns = line_width(stderr) - 1;
  const size_t count_columns = std::min(std::strlen(count), columns);
  std::string line = name_.substr(0, columns - count_columns) + std::string(count, count_columns);
  const auto add = [&](const std::string& text) {
    if (line.size() + 2 + text.size() <= columns) line += "  " + text;
  };
  const double elapsed = seconds_since(start_), phase = seconds_since(phase_start_);
  const uint64_t items = items_.load(std::memory_order_relaxed);
  if (elapsed >= 1) add(clock_text(elapsed));
  const double worked = share(done) - skipped_;
  if (elapsed >= 1 && worked >= kMinShare * (1 - skipped_))
    add("about " + clock_text(elapsed * (1 - share(done)) / worked) + " left");
  if (!unit_.empty() && phase >= kMinSeconds) add(rate_text(double(items) / phase, unit_));
  if (budget_ != nullptr && budget_->limit() != MemoryBudget::kUnlimited)
    add(memory_text(budget_->used()) + " of " + memory_text(budget_->limit()));
  show(line);
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
