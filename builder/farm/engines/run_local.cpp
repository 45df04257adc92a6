#include "builder/farm/engines/run_local.h"

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "builder/farm/engines/live_table.h"
#include "builder/farm/engines/run_report.h"
#include "builder/farm/engines/run_step.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "streaming/error.h"
#include "streaming/process/child_process.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;
using Time = std::filesystem::file_time_type;

constexpr int kMaxAttempts = 2;
constexpr auto kStepPollInterval = std::chrono::milliseconds(20);        // of our processes
constexpr auto kElsewherePollInterval = std::chrono::milliseconds(500);  // of other processes

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// 0 if the log does not exist yet.
uint64_t size_of(const std::string& log) {
  std::error_code none;
  const auto size = std::filesystem::file_size(log, none);
  return none ? 0 : size;
}

// The last line after byte `begin` of a log; the text before that is of earlier attempts.
std::string last_line_since(const std::string& log, uint64_t begin) {
  const File file = File::open_read(log);
  const uint64_t size = file.size();
  std::string text(std::min<uint64_t>(size - std::min(size, begin), 4096), ' ');
  file.read_at(size - text.size(), std::as_writable_bytes(std::span(text)));
  return last_line_of(text);
}

// The reason reported for a failed step that printed no message.
std::string reason_from_code(int code) {
  if (code <= 128) return "no message, exit code " + std::to_string(code);
  return "killed by signal " + std::to_string(code - 128) +
         (code == 128 + SIGKILL ? ", often for lack of memory: run fewer steps at once with -j"
                                : "");
}

class Runner {
 public:
  Runner(const Plan& plan, const RunLocalConfig& config)
      : plan_(plan),
        config_(config),
        rows_(plan.steps.size()),
        receipt_times_(plan.steps.size()),
        log_begins_(plan.steps.size()),
        table_(plan, config.table, config.quiet) {}

  void run() {
    skip_if_finished();
    try {
      while (!is_over()) {
        check_interrupt();
        start_ready();
        std::this_thread::sleep_for(kStepPollInterval);
        for (size_t i = 0; i < rows_.size(); ++i) poll(i);
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
    if (config_.json) std::fputs(run_json(plan_, rows_).c_str(), stdout);
    fail_if_any_failed();
  }

 private:
  // The outputs of a finished plan may be removed, except the last.
  void skip_if_finished() {
    if (!is_finished(plan_, true)) return;
    for (size_t i = 0; i < rows_.size(); ++i) {
      rows_[i].state = StepState::kDone;
      rows_[i].done_before = true;
      rows_[i].receipt = read_receipt(plan_, plan_.steps[i]);
      table_.print(i, rows_[i]);
    }
  }

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

  // Starts ready steps, last those that another process ran when they were last checked.
  void start_ready() {
    fail_dependents();
    size_t started = running();
    for (const bool elsewhere : {false, true}) {
      for (size_t i = 0; i < rows_.size() && started < config_.processes; ++i) {
        if (rows_[i].elsewhere == elsewhere && is_ready(i)) started += start_or_wait(i);
      }
    }
  }

  // Fails the steps whose inputs failed. They are never started, so their code stays 0.
  void fail_dependents() {
    for (size_t i = 0; i < rows_.size(); ++i) {
      const auto& inputs = plan_.steps[i].inputs;
      const auto failed = [&](size_t input) { return rows_[input].state == StepState::kFailed; };
      if (std::any_of(inputs.begin(), inputs.end(), failed)) rows_[i].state = StepState::kFailed;
    }
  }

  bool is_ready(size_t i) const {
    if (rows_[i].state != StepState::kWaiting || Clock::now() < rows_[i].next_check) return false;
    const auto& inputs = plan_.steps[i].inputs;
    return std::all_of(inputs.begin(), inputs.end(),
                       [&](size_t input) { return rows_[input].state == StepState::kDone; });
  }

  // Returns false if another process runs the step. No process is started that would only wait.
  bool start_or_wait(size_t i) {
    StepConfig step;
    step.scratch = config_.scratch;
    const bool elsewhere = runs_elsewhere(plan_, plan_.steps[i], step);
    elsewhere ? wait_for_other_process(i) : start(i);
    return !elsewhere;
  }

  void wait_for_other_process(size_t i) {
    StepRow& row = rows_[i];
    row.state = StepState::kWaiting;
    row.next_check = Clock::now() + kElsewherePollInterval;
    if (row.elsewhere) return;  // already printed
    row.elsewhere = true;
    table_.print(i, row);
  }

  void start(size_t i) {
    StepRow& row = rows_[i];
    std::vector<std::string> command = {config_.program.empty() ? own_image() : config_.program};
    for (const std::string& word : plan_.command(plan_.steps[i])) command.push_back(word);
    command.push_back("--verbose");  // the log of a step has what it took
    if (plan_.steps[i].is_colours()) command.push_back("-j" + std::to_string(threads_alone(i)));
    if (!config_.scratch.empty()) command.push_back("--scratch=" + config_.scratch);
    if (config_.keep && i + 1 == rows_.size()) command.push_back("--keep");
    row.begin = Clock::now();
    receipt_times_[i] = receipt_time(i);
    make_folder(plan_.path("logs"));  // a copy of a plan may lack empty folders
    log_begins_[i] = size_of(log_of(i));
    row.process = start_process(command, log_of(i));
    row.state = StepState::kRunning;
    ++row.attempts;
  }

  // The threads of a step that runs alone: those of all processes that its memory is enough for.
  size_t threads_alone(size_t i) const {
    const PlanStep& step = plan_.steps[i];
    const uint64_t above_base = std::max(step.predicted.budget, kBaseBudget) - kBaseBudget;
    return std::max(step.threads, std::min(config_.processes, size_t(above_base / kThreadBudget)));
  }

  // Modification time of the step's receipt; Time::min() if it does not exist.
  Time receipt_time(size_t i) const {
    std::error_code none;
    return std::filesystem::last_write_time(receipt_path(plan_, plan_.steps[i]), none);
  }

  void poll(size_t i) {
    StepRow& row = rows_[i];
    if (row.state != StepState::kRunning || !has_ended(row.process, &row.code)) return;
    row.seconds = seconds_since(row.begin);
    if (row.code == 0) {
      row.state = StepState::kDone;
      row.receipt = read_receipt(plan_, plan_.steps[i]);
      row.done_before = receipt_times_[i] != Time::min() && receipt_times_[i] == receipt_time(i);
    } else if (row.code == int(kRunsElsewhere)) {
      --row.attempts;
      return wait_for_other_process(i);
    } else if (is_temporary_failure(row.code) && row.attempts < kMaxAttempts) {
      row.state = StepState::kWaiting;
      row.elsewhere = false;
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
    std::string reason = last_line_since(log_of(first), log_begins_[first]);
    if (reason.starts_with("svdag: ")) reason = reason.substr(7);
    if (reason.empty()) reason = reason_from_code(rows_[first].code);
    throw Error(ExitCode(rows_[first].code),
                (failed == 1 ? "" : std::to_string(failed) + " steps failed, first ") +
                    plan_.steps[first].name + " failed: " + reason + " (" + log_of(first) + ")");
  }

  std::string log_of(size_t i) const { return plan_.path("logs/" + plan_.steps[i].name + ".log"); }

  const Plan& plan_;
  const RunLocalConfig& config_;
  std::vector<StepRow> rows_;         // by step
  std::vector<Time> receipt_times_;   // before the steps were started
  std::vector<uint64_t> log_begins_;  // sizes of the logs before the steps were started
  LiveTable table_;
};

}  // namespace

bool is_temporary_failure(int code) {
  return code == int(ExitCode::kOutput) || code == int(ExitCode::kMemory) ||
         code == int(kRunsElsewhere) || code > 128;
}

void run_local(const Plan& plan, const RunLocalConfig& config) {
  Runner(plan, config).run();
}

}  // namespace svdag
