// Progress of a running plan: on a terminal a table of the running steps and a line of sums,
// redrawn in place; otherwise a line for each step that ends.
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
  bool others = false;                              // another process does it, and is waited for
  std::chrono::steady_clock::time_point next_look;  // when to check that it still does
  int code = 0;                                     // of the last attempt
  bool already = false;                             // was done before this run
  pid_t process = 0;
  std::chrono::steady_clock::time_point begin;
  double seconds = 0;
  std::optional<Receipt> receipt;
};

class LiveTable {
 public:
  // `live`: draws on stderr. `quiet`: prints nothing.
  LiveTable(const Plan& plan, bool live, bool quiet);

  // Prints a step that has ended.
  void print(size_t step, const StepRow& row);
  // At most ten times a second.
  void draw(const std::vector<StepRow>& rows);
  void clear();
  void finish(const std::vector<StepRow>& rows);

 private:
  template <class... Values>
  void line(const char* format, Values... values);

  const Plan& plan_;
  bool live_, quiet_;
  size_t lines_ = 0;  // drawn
  std::chrono::steady_clock::time_point begin_, next_;
};

}  // namespace svdag
