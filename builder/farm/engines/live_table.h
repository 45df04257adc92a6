// What a running plan shows: on a terminal a table of the steps that run and a line of sums, drawn
// over and over; otherwise a line for each step that ends.
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
  bool others = false;  // somebody else's process does it, which is waited for
  std::chrono::steady_clock::time_point next_look;  // whether it still does
  int code = 0;                                     // of the last attempt
  bool already = false;                             // was done before it was asked for
  pid_t process = 0;
  std::chrono::steady_clock::time_point begin;
  double seconds = 0;
  std::optional<Receipt> receipt;
};

class LiveTable {
 public:
  // `live`: draws on stderr. `quiet`: says nothing at all.
  LiveTable(const Plan& plan, bool live, bool quiet);

  // A step has ended.
  void tell(size_t step, const StepRow& row);
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
