// Progress display of a running plan. On a terminal, a table of the running steps and a line of
// totals, redrawn in place; otherwise a line per step that ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <vector>

#include "builder/farm/plan/receipt.h"

namespace svdag {

enum class StepState { kWaiting, kRunning, kDone, kFailed };

struct StepRow {
  StepState state = StepState::kWaiting;
  int attempts = 0;
  bool elsewhere = false;                            // another process runs the step
  std::chrono::steady_clock::time_point next_check;  // when to check that it still runs
  int code = 0;                                      // exit code of the last attempt
  bool done_before = false;                          // was done before this run
  pid_t process = 0;
  std::chrono::steady_clock::time_point begin;
  double seconds = 0;
  std::optional<Receipt> receipt;
};

class LiveTable {
 public:
  // If `live`, draws a table on stderr; if `quiet`, prints nothing.
  LiveTable(const Plan& plan, bool live, bool quiet);

  // Prints a line about a step that ended or that another process runs.
  void print(size_t step, const StepRow& row);
  // Draws at most ten times a second.
  void draw(const std::vector<StepRow>& rows);
  void clear();
  void finish(const std::vector<StepRow>& rows);

 private:
  template <class... Values>
  void line(const char* format, Values... values);

  const Plan& plan_;
  bool live_, quiet_;
  size_t lines_ = 0;  // number of lines drawn
  std::chrono::steady_clock::time_point begin_, next_draw_;
};

}  // namespace svdag
