#include "builder/farm/engines/live_table.h"

#include <algorithm>
#include <cstdio>

#include "io/units.h"
#include "streaming/process/terminal.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMaxRows = 20;

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

LiveTable::LiveTable(const Plan& plan, bool live, bool quiet)
    : plan_(plan), live_(live && !quiet), quiet_(quiet), begin_(Clock::now()), next_draw_(begin_) {}

void LiveTable::print(size_t step, const StepRow& row) {
  if (quiet_) return;
  const PlanStep& s = plan_.steps[step];
  if (row.state == StepState::kDone) {
    if (live_) return;
    if (row.done_before) {
      std::printf("%-10s already done\n", s.name.c_str());
      return;
    }
    std::printf("%-10s done in %.1f s (planned %.1f s)", s.name.c_str(), row.seconds,
                s.predicted.seconds);
    if (row.receipt)
      std::printf(", %s of memory (planned %s), %s", format_bytes(row.receipt->memory).c_str(),
                  format_bytes(s.predicted.memory).c_str(),
                  format_bytes(row.receipt->bytes).c_str());
    std::printf("\n");
  } else if (row.state == StepState::kWaiting && row.elsewhere) {
    clear();
    std::printf("%-10s waiting: another process is running it\n", s.name.c_str());
  } else {
    clear();
    std::printf("%-10s failed with exit code %d%s\n", s.name.c_str(), row.code,
                row.state == StepState::kFailed ? "" : ": retrying");
  }
  std::fflush(stdout);
}

// Truncates to the width of the terminal, since clear() assumes that a line is one row.
template <class... Values>
void LiveTable::line(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  std::fprintf(stderr, "%.*s\n", int(line_width(stderr) - 1), text);
  ++lines_;
}

void LiveTable::draw(const std::vector<StepRow>& rows) {
  if (!live_ || Clock::now() < next_draw_) return;
  next_draw_ = Clock::now() + std::chrono::milliseconds(100);
  clear();
  size_t done = 0, failed = 0;
  double planned = 0, planned_done = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    planned += plan_.steps[i].predicted.cpu;
    done += rows[i].state == StepState::kDone;
    failed += rows[i].state == StepState::kFailed;
    if (rows[i].state == StepState::kDone) planned_done += plan_.steps[i].predicted.cpu;
    if (rows[i].state != StepState::kRunning || lines_ >= kMaxRows) continue;
    line("  %-12s %8.1f s of %.1f s", plan_.steps[i].name.c_str(),
         seconds(Clock::now() - rows[i].begin), plan_.steps[i].predicted.seconds);
  }
  line("  %zu of %zu steps done, %zu failed; %.0f %% of the work; %.1f s", done, rows.size(),
       failed, planned > 0 ? 100 * planned_done / planned : 0, seconds(Clock::now() - begin_));
  std::fflush(stderr);
}

void LiveTable::clear() {
  for (; lines_ > 0; --lines_) std::fprintf(stderr, "\x1b[1A\x1b[2K");
  std::fflush(stderr);
}

void LiveTable::finish(const std::vector<StepRow>& rows) {
  clear();
  if (quiet_) return;
  double cpu = 0;
  uint64_t memory = 0;
  size_t done = 0, done_before = 0;
  for (const StepRow& row : rows) {
    done += row.state == StepState::kDone;
    done_before += row.done_before;
    if (!row.receipt || row.done_before) continue;
    cpu += row.receipt->cpu;
    memory = std::max(memory, row.receipt->memory);
  }
  if (done_before == rows.size()) {
    std::printf("%zu of %zu steps were done before\n", done_before, rows.size());
    return;
  }
  const std::string before =
      done_before == 0 ? "" : " (" + std::to_string(done_before) + " already done)";
  std::printf(
      "%zu of %zu steps done%s in %.1f s: %.1f CPU seconds, at most %s of memory in a step\n", done,
      rows.size(), before.c_str(), seconds(Clock::now() - begin_), cpu,
      format_bytes(memory).c_str());
}

}  // namespace svdag
