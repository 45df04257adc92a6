#include "builder/farm/engines/run_local.h"

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "builder/farm/engines/live_table.h"
#include "builder/farm/engines/process.h"
#include "builder/farm/engines/run_step.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;
using Time = std::filesystem::file_time_type;

constexpr int kAttempts = 2;
constexpr auto kLook = std::chrono::milliseconds(20);  // between two looks at the processes
constexpr auto kLookAtOthers = std::chrono::milliseconds(500);  // and at what others do

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// 0 if the log does not exist yet.
uint64_t size_of(const std::string& log) {
  std::error_code none;
  const auto size = std::filesystem::file_size(log, none);
  return none ? 0 : size;
}

// The last line after byte `begin` of a log; the text before it is of earlier attempts.
std::string last_words(const std::string& log, uint64_t begin) {
  const File file = File::open_read(log);
  const uint64_t size = file.size();
  std::string text(std::min<uint64_t>(size - std::min(size, begin), 4096), ' ');
  file.read_at(size - text.size(), std::as_writable_bytes(std::span(text)));
  return last_line_of(text);
}

// Why a step failed that said nothing.
std::string reason_of(int code) {
  if (code <= 128) return "it said nothing, exit code " + std::to_string(code);
  return "it was ended by signal " + std::to_string(code - 128) +
         (code == 128 + SIGKILL
              ? ", often because no memory was left: run fewer steps at once with -j"
              : "");
}

class Runner {
 public:
  Runner(const Plan& plan, const RunLocalConfig& config)
      : plan_(plan),
        config_(config),
        rows_(plan.steps.size()),
        written_(plan.steps.size()),
        said_(plan.steps.size()),
        table_(plan, config.table, config.quiet) {}

  void run() {
    try {
      while (!is_over()) {
        check_interrupt();
        start_ready();
        std::this_thread::sleep_for(kLook);
        for (size_t i = 0; i < rows_.size(); ++i) look_after(i);
        table_.draw(rows_);
      }
    } catch (...) {
      std::vector<pid_t> processes;
      for (const StepRow& row : rows_) {
        if (row.state == StepState::kRunning) processes.push_back(row.process);
      }
      table_.clear();
      stop_processes(processes);
      throw;
    }
    table_.finish(rows_);
    fail_if_any_failed();
  }

 private:
  size_t running() const {
    return size_t(std::count_if(rows_.begin(), rows_.end(), [](const StepRow& row) {
      return row.state == StepState::kRunning;
    }));
  }

  bool is_over() const {
    return std::none_of(rows_.begin(), rows_.end(), [](const StepRow& row) {
      return row.state == StepState::kWaiting || row.state == StepState::kRunning;
    });
  }

  // Starts what can be started; last what was others' when it was looked at before.
  void start_ready() {
    fail_what_lacks_inputs();
    size_t started = running();
    for (const bool others : {false, true}) {
      for (size_t i = 0; i < rows_.size() && started < config_.processes; ++i) {
        if (rows_[i].others == others && is_ready(i)) started += start_or_wait(i);
      }
    }
  }

  // Never started: the code of such a step stays 0.
  void fail_what_lacks_inputs() {
    for (size_t i = 0; i < rows_.size(); ++i) {
      const auto& inputs = plan_.steps[i].inputs;
      const auto failed = [&](size_t input) { return rows_[input].state == StepState::kFailed; };
      if (std::any_of(inputs.begin(), inputs.end(), failed)) rows_[i].state = StepState::kFailed;
    }
  }

  bool is_ready(size_t i) const {
    if (rows_[i].state != StepState::kWaiting || Clock::now() < rows_[i].next_look) return false;
    const auto& inputs = plan_.steps[i].inputs;
    return std::all_of(inputs.begin(), inputs.end(),
                       [&](size_t input) { return rows_[input].state == StepState::kDone; });
  }

  // Returns false if another process does the step: no process of ours then waits for it instead of
  // doing another step.
  bool start_or_wait(size_t i) {
    StepConfig step;
    step.scratch = config_.scratch;
    const bool others = is_being_done(plan_, plan_.steps[i], step);
    others ? wait_for_others(i) : start(i);
    return !others;
  }

  void wait_for_others(size_t i) {
    StepRow& row = rows_[i];
    row.state = StepState::kWaiting;
    row.next_look = Clock::now() + kLookAtOthers;
    if (row.others) return;  // said before
    row.others = true;
    table_.print(i, row);
  }

  void start(size_t i) {
    StepRow& row = rows_[i];
    std::vector<std::string> command = {config_.program.empty() ? own_image() : config_.program};
    for (const std::string& word : plan_.command(plan_.steps[i])) command.push_back(word);
    command.push_back("--quiet");
    if (!config_.scratch.empty()) command.push_back("--scratch=" + config_.scratch);
    row.begin = Clock::now();
    written_[i] = last_write(i);
    make_folder(plan_.path("logs"));  // a copy of a plan may lack what was empty
    said_[i] = size_of(log_of(i));
    row.process = start_process(command, log_of(i));
    row.state = StepState::kRunning;
    ++row.attempts;
  }

  // Of the step's receipt; the earliest time without a receipt.
  Time last_write(size_t i) const {
    std::error_code none;
    return std::filesystem::last_write_time(receipt_path(plan_, plan_.steps[i]), none);
  }

  void look_after(size_t i) {
    StepRow& row = rows_[i];
    if (row.state != StepState::kRunning || !has_ended(row.process, &row.code)) return;
    row.seconds = seconds_since(row.begin);
    if (row.code == 0) {
      row.state = StepState::kDone;
      row.receipt = read_receipt(plan_, plan_.steps[i]);
      row.already = written_[i] != Time::min() && written_[i] == last_write(i);
    } else if (row.code == int(kDoneElsewhere)) {
      --row.attempts;
      return wait_for_others(i);
    } else if (may_pass(row.code) && row.attempts < kAttempts) {
      row.state = StepState::kWaiting;
      row.others = false;
    } else {
      row.state = StepState::kFailed;
    }
    table_.print(i, row);
  }

  void fail_if_any_failed() const {
    size_t failed = 0, first = rows_.size();
    for (size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].state != StepState::kFailed || rows_[i].code == 0) continue;
      ++failed;
      first = std::min(first, i);
    }
    if (failed == 0) return;
    std::string said = last_words(log_of(first), said_[first]);
    if (said.starts_with("svdag: ")) said = said.substr(7);
    if (said.empty()) said = reason_of(rows_[first].code);
    throw Error(ExitCode(rows_[first].code),
                (failed == 1 ? "" : std::to_string(failed) + " steps failed, first ") +
                    plan_.steps[first].name + " failed: " + said + " (" + log_of(first) + ")");
  }

  std::string log_of(size_t i) const { return plan_.path("logs/" + plan_.steps[i].name + ".log"); }

  const Plan& plan_;
  const RunLocalConfig& config_;
  std::vector<StepRow> rows_;   // by step
  std::vector<Time> written_;   // when the receipts were, before the steps began
  std::vector<uint64_t> said_;  // bytes of the logs, before the steps began
  LiveTable table_;
};

}  // namespace

bool may_pass(int code) {
  return code == int(ExitCode::kOutput) || code == int(ExitCode::kMemory) ||
         code == int(kDoneElsewhere) || code > 128;
}

void run_local(const Plan& plan, const RunLocalConfig& config) {
  Runner(plan, config).run();
}

}  // namespace svdag
