#include "builder/farm/run_local.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "builder/farm/live_table.h"
#include "builder/farm/process.h"
#include "builder/farm/receipt.h"
#include "builder/farm/run_step.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kAttempts = 2;
constexpr auto kLook = std::chrono::milliseconds(20);  // between two looks at the processes

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// The last line of a log: what the step said when it failed.
std::string last_line(const std::string& path) {
  const File file = File::open_read(path);
  const uint64_t size = file.size(), most = std::min<uint64_t>(size, 4096);
  std::string text(most, ' ');
  file.read_at(size - most, std::as_writable_bytes(std::span(text)));
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.find_last_of('\n') + 1);
}

class Runner {
 public:
  Runner(const Plan& plan, const RunLocalConfig& config)
      : plan_(plan),
        config_(config),
        rows_(plan.steps.size()),
        table_(plan, config.table, config.quiet) {}

  void run() {
    try {
      while (start_ready() || running() > 0) {
        check_interrupt();
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

  // Starts what can be started; true if something was.
  bool start_ready() {
    bool started = false;
    for (size_t i = 0; i < rows_.size() && running() < config_.processes; ++i) {
      if (rows_[i].state != StepState::kWaiting) continue;
      const auto& inputs = plan_.steps[i].inputs;
      const auto is = [&](StepState state) {
        return [this, state](size_t input) { return rows_[input].state == state; };
      };
      if (std::any_of(inputs.begin(), inputs.end(), is(StepState::kFailed))) {
        rows_[i].state = StepState::kFailed;  // never started: its code stays 0
        started = true;                       // others may fail by it
      } else if (std::all_of(inputs.begin(), inputs.end(), is(StepState::kDone))) {
        start(i);
        started = true;
      }
    }
    return started;
  }

  void start(size_t i) {
    StepRow& row = rows_[i];
    std::vector<std::string> command = {config_.program.empty() ? own_program() : config_.program};
    for (const std::string& word : plan_.command(plan_.steps[i])) command.push_back(word);
    command.push_back("--quiet");
    if (!config_.scratch.empty()) {
      command.push_back("--scratch");
      command.push_back(config_.scratch);
    }
    row.begin = Clock::now();
    row.process = start_process(command, log_of(i));
    row.state = StepState::kRunning;
    ++row.attempts;
  }

  void look_after(size_t i) {
    StepRow& row = rows_[i];
    if (row.state != StepState::kRunning || !has_ended(row.process, &row.code)) return;
    row.seconds = seconds_since(row.begin);
    if (row.code == 0) {
      row.state = StepState::kDone;
      row.receipt = read_receipt(plan_, plan_.steps[i]);
    } else if (row.code == int(ExitCode::kOutput) && is_others(i)) {
      row.state = StepState::kWaiting;
      --row.attempts;
      if (row.others) return;  // said before
      row.others = true;
    } else if (may_pass(row.code) && row.attempts < kAttempts) {
      row.state = StepState::kWaiting;
      row.others = false;
    } else {
      row.state = StepState::kFailed;
    }
    table_.tell(i, row);
  }

  bool is_others(size_t i) const {
    StepConfig step;
    step.scratch = config_.scratch;
    return is_being_done(plan_, plan_.steps[i], step);
  }

  void fail_if_any_failed() const {
    size_t failed = 0, first = rows_.size();
    for (size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].state != StepState::kFailed || rows_[i].code == 0) continue;
      ++failed;
      first = std::min(first, i);
    }
    if (failed == 0) return;
    std::string said = last_line(log_of(first));
    if (said.starts_with("svdag: ")) said = said.substr(7);
    throw Error(ExitCode(rows_[first].code),
                (failed == 1 ? "" : std::to_string(failed) + " steps failed, first ") +
                    plan_.steps[first].name + " failed: " + said + " (" + log_of(first) + ")");
  }

  std::string log_of(size_t i) const { return plan_.path("logs/" + plan_.steps[i].name + ".log"); }

  const Plan& plan_;
  const RunLocalConfig& config_;
  std::vector<StepRow> rows_;  // by step
  LiveTable table_;
};

}  // namespace

bool may_pass(int code) {
  return code == int(ExitCode::kOutput) || code == int(ExitCode::kMemory) || code > 128;
}

void run_local(const Plan& plan, const RunLocalConfig& config) {
  Runner(plan, config).run();
}

}  // namespace svdag
