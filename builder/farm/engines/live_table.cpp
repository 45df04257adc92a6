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
    : plan_(plan), live_(live && !quiet), quiet_(quiet), begin_(Clock::now()), next_(begin_) {}

void LiveTable::print(size_t step, const StepRow& row) {
  if (quiet_) return;
  const PlanStep& s = plan_.steps[step];
  if (row.state == StepState::kDone) {
    if (live_) return;
    if (row.already) {
      std::printf("%-10s is done already\n", s.name.c_str());
      return;
    }
    std::printf("%-10s done in %.1f s (planned %.1f s)", s.name.c_str(), row.seconds,
                s.predicted.seconds);
    if (row.receipt)
      std::printf(", %s of memory (planned %s), %s", format_bytes(row.receipt->memory).c_str(),
                  format_bytes(s.predicted.memory).c_str(),
                  format_bytes(row.receipt->bytes).c_str());
    std::printf("\n");
  } else if (row.state == StepState::kWaiting && row.others) {
    clear();
    std::printf("%-10s is being done by another process: waiting for it\n", s.name.c_str());
  } else {
    clear();
    std::printf("%-10s %s with exit code %d\n", s.name.c_str(),
                row.state == StepState::kFailed ? "failed" : "is tried again: it ended", row.code);
  }
  std::fflush(stdout);
}

// Cut where the terminal ends: clear() takes back as many rows as there were lines.
template <class... Values>
void LiveTable::line(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  std::fprintf(stderr, "%.*s\n", int(line_width(stderr) - 1), text);
  ++lines_;
}

void LiveTable::draw(const std::vector<StepRow>& rows) {
  if (!live_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
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
  size_t done = 0, already = 0;
  for (const StepRow& row : rows) {
    done += row.state == StepState::kDone;
    already += row.already;
    if (!row.receipt || row.already) continue;
    cpu += row.receipt->cpu;
    memory = std::max(memory, row.receipt->memory);
  }
  const std::string before =
      already == 0 ? "" : " (" + std::to_string(already) + " of them before)";
  std::printf(
      "%zu of %zu steps done%s in %.1f s: %.1f CPU seconds, at most %s of memory in a step\n", done,
      rows.size(), before.c_str(), seconds(Clock::now() - begin_), cpu,
      format_bytes(memory).c_str());
}

}  // namespace svdag
