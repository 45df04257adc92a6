#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "builder/farm/engines/farm_engine.h"
#include "builder/farm/plan/plan_folder.h"
#include "builder/farm/plan/receipt.h"
#include "builder/farm/plan/step_name.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/printable.h"
#include "streaming/process/child_process.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/shell.h"

namespace svdag {
namespace {

constexpr size_t kDefaultArraySize = 1000;  // if Slurm does not report MaxArraySize
constexpr size_t kMaxArraySize = 10000;     // a longer task list may not fit in a command line
constexpr uint64_t kMinMinutes = 10;
constexpr uint64_t kMebibyte = uint64_t(1) << 20;
constexpr auto kQueuePollInterval = std::chrono::milliseconds(500);
constexpr int kMaxFailedPolls = 120;  // consecutive failures of squeue

// The steps submitted by one sbatch.
struct Job {
  std::string name;
  std::vector<size_t> steps;  // shards, or one merge
  std::string script;         // path of the job script
  uint64_t memory = 0;
  size_t threads = 1;
  double seconds = 0;
  std::string id;  // once submitted
};

ProcessResult run_sbatch(const std::vector<std::string>& command) {
  try {
    return run_process(command);
  } catch (const Error& error) {
    fail_usage(std::string(error.what()) + ": is Slurm installed?");
  }
}

// The largest power of ten that is at most MaxArraySize (task numbers are 0 .. size - 1); 1 if
// Slurm has no arrays.
size_t array_size() {
  ProcessResult result;
  try {
    result = run_process({"scontrol", "show", "config"});
  } catch (const Error&) {  // scontrol is not installed
    return kDefaultArraySize;
  }
  const size_t at = result.code == 0 ? result.output.find("MaxArraySize") : std::string::npos;
  const size_t digits = result.output.find_first_of("0123456789", at);
  if (at == std::string::npos || digits == std::string::npos) return kDefaultArraySize;
  const uint64_t max_size = std::strtoull(result.output.c_str() + digits, nullptr, 10);
  size_t size = 1;
  while (size < kMaxArraySize && 10 * size <= max_size) size *= 10;
  return size;
}

// The tasks of an array as sbatch lists them: "3,5-7" for 3, 5, 6, 7.
std::string task_list(const std::vector<size_t>& numbers) {
  std::string list;
  for (size_t begin = 0, end; begin < numbers.size(); begin = end) {
    for (end = begin + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) ++end;
    list += (list.empty() ? "" : ",") + std::to_string(numbers[begin]);
    if (end - begin > 1) list += "-" + std::to_string(numbers[end - 1]);
  }
  return list;
}

// Escapes % in the path of a log, where it begins a pattern of Slurm.
std::string escape_patterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

// Reports that the jobs `ids` (separated by commas) stay queued.
void report_queued(const char* prefix, std::string ids) {
  std::fprintf(stderr, "svdag: %ssubmitted jobs stay queued: list them with squeue --jobs=%s",
               prefix, ids.c_str());
  std::replace(ids.begin(), ids.end(), ',', ' ');
  std::fprintf(stderr, ", cancel them with scancel %s\n", ids.c_str());
}

class Submission {
 public:
  Submission(const Plan& plan, const SubmitConfig& config)
      : plan_(plan), config_(config), array_size_(array_size()) {}

  void run() {
    collect();
    if (jobs_.empty()) {
      if (!config_.quiet) std::printf("every step of the plan is done\n");
      return;
    }
    make_folder(plan_.path("logs"));  // a copy of a plan may lack empty folders
    submit_all();
    if (config_.wait) wait();
  }
  // The ids of the submitted jobs, separated by commas.
  std::string job_ids() const {
    std::string ids;
    for (const Job& job : jobs_) {
      if (!job.id.empty()) ids += (ids.empty() ? "" : ",") + job.id;
    }
    return ids;
  }

 private:
  void collect();
  void add(size_t step, Job* job) const;
  // Shards are the first steps of a plan.
  static size_t number_of(size_t shard) { return shard + 1; }
  size_t task_of(size_t shard) const { return number_of(shard) % array_size_; }
  bool is_array(const Job& job) const {
    return array_size_ > 1 && plan_.steps[job.steps.front()].is_shard();
  }
  std::string log_of(const Job& job) const;
  void submit_all();
  void submit(Job* job);
  std::string script_of(const Job& job) const;
  std::string dependencies_of(const Job& job) const;
  void wait() const;
  bool any_queued(const std::string& ids) const;

  const Plan& plan_;
  const SubmitConfig& config_;
  size_t array_size_;  // an array holds the shards with the same number / array_size_
  std::vector<Job> jobs_;
  std::map<size_t, std::string> ids_;  // by submitted step: "12" or "12_3"
};

void Submission::collect() {
  if (is_finished(plan_, true)) return;
  const size_t none = SIZE_MAX;
  size_t current = none;  // number of the last job's array
  for (size_t i = 0; i < plan_.steps.size(); ++i) {
    const PlanStep& step = plan_.steps[i];
    // Checks every byte: no job would repair a damaged output later.
    if (output_state(plan_, step, plan_.path(step.output), true) == OutputState::kValid) continue;
    const size_t array = step.is_shard() && array_size_ > 1 ? number_of(i) / array_size_ : none;
    if (array == none || array != current) {
      jobs_.emplace_back();
      jobs_.back().name =
          array == none ? step.name
                        : "shards-" + std::to_string(std::max<size_t>(1, array * array_size_));
    }
    current = array;
    add(i, &jobs_.back());
  }
}

void Submission::add(size_t i, Job* job) const {
  const PlanStep& step = plan_.steps[i];
  job->steps.push_back(i);
  job->memory = std::max(job->memory, step.predicted.memory);
  job->threads = std::max(job->threads, step.threads);
  job->seconds = std::max(job->seconds, step.predicted.seconds);
}

// The script of a job. It runs one step; in an array, the step of its task.
std::string Submission::script_of(const Job& job) const {
  const PlanStep& step = plan_.steps[job.steps.front()];
  std::vector<std::string> words = plan_.command(step);
  if (is_array(job)) words.pop_back();  // the name of the step
  std::string command = shell_word(program_on_hosts(config_.program));
  for (const std::string& word : words) command += " " + shell_word(word);
  if (is_array(job))
    command +=
        " \"" +
        shard_name("$((SLURM_ARRAY_TASK_ID + " +
                   std::to_string(number_of(job.steps.front()) - task_of(job.steps.front())) +
                   "))") +
        "\"";
  if (!config_.scratch.empty())
    command += " --scratch " + shell_word(absolute_unresolved(config_.scratch));
  if (config_.keep && step.name == plan_.steps.back().name) command += " --keep";
  return "#!/bin/sh\n" + command +
         "\n"
         "code=$?\n"
         "# Retries temporary failures only: disk, memory, another process, a signal.\n"
         "case $code in\n"
         "  4 | 5 | 75 | 12[89] | 1[3-9]? | 2[0-9][0-9])\n"
         "    if [ \"${SLURM_RESTART_COUNT:-0}\" -lt 2 ]; then\n"
         "      scontrol requeue \"$SLURM_JOB_ID\" && sleep 60\n"
         "    fi ;;\n"
         "esac\n"
         "exit $code\n";
}

std::string Submission::dependencies_of(const Job& job) const {
  std::string list;
  for (const size_t input : plan_.steps[job.steps.front()].inputs) {
    if (const auto id = ids_.find(input); id != ids_.end()) list += ":" + id->second;
  }
  return list;
}

// Each shard's log is named by the shard's number: the number of its array, then that of the task
// with leading zeros.
std::string Submission::log_of(const Job& job) const {
  std::string name = job.name;
  if (is_array(job)) {
    const size_t array = number_of(job.steps.front()) / array_size_;
    const size_t digits = std::to_string(array_size_).size() - 1;
    name =
        shard_name(array == 0 ? "%a" : std::to_string(array) + "%" + std::to_string(digits) + "a");
  }
  return escape_patterns(plan_.folder) + "/logs/" + name + ".slurm.log";
}

void Submission::submit_all() {
  try {
    for (Job& job : jobs_) submit(&job);
  } catch (const Error&) {
    if (const std::string ids = job_ids(); !ids.empty()) report_queued("", ids);
    throw;
  }
}

void Submission::submit(Job* job) {
  job->script = plan_.path("logs/" + job->name + ".sh");
  AtomicFile file(job->script);
  file.append(script_of(*job));
  file.commit();
  const bool array = is_array(*job);
  const uint64_t minutes = std::max(kMinMinutes, uint64_t(kTimeMargin * job->seconds / 60) + 1);
  std::vector<std::string> command = {
      "sbatch",
      "--parsable",
      "--requeue",
      "--open-mode=append",
      "--job-name=" + job->name,
      "--output=" + log_of(*job),
      "--mem=" + std::to_string((job->memory + kMebibyte - 1) / kMebibyte) + "M",
      "--cpus-per-task=" + std::to_string(job->threads),
      "--time=" + std::to_string(minutes)};
  if (array) {
    std::vector<size_t> tasks;
    for (const size_t i : job->steps) tasks.push_back(task_of(i));
    command.push_back("--array=" + task_list(tasks));
  }
  const std::string after = dependencies_of(*job);
  if (!after.empty()) {
    command.push_back("--dependency=afterok" + after);
    command.push_back("--kill-on-invalid-dep=yes");
  }
  command.insert(command.end(), config_.options.begin(), config_.options.end());
  command.push_back(job->script);
  const ProcessResult result = run_sbatch(command);
  if (result.code != 0)  // may be temporary: a job limit, a restart of the controller
    throw Error(ExitCode::kOutput, "sbatch rejected " + job->name + ": " + one_line(result.output));
  // ID[;CLUSTER], after any warnings of sbatch
  const std::string line = last_line_of(result.output);
  job->id = line.substr(0, line.find(';'));
  for (const size_t i : job->steps)
    ids_[i] = array ? job->id + "_" + std::to_string(task_of(i)) : job->id;
  if (!config_.quiet)
    std::printf("%s: job %s%s%s\n", job->name.c_str(), job->id.c_str(),
                after.empty() ? "" : " after ", after.empty() ? "" : after.c_str() + 1);
  std::fflush(stdout);
}

// Whether one of the jobs is queued or running.
bool Submission::any_queued(const std::string& ids) const {
  const ProcessResult result =
      run_process({"squeue", "--noheader", "--array", "--jobs=" + ids, "--format=%T"});
  // squeue reports jobs that ended a while ago as invalid.
  if (result.code != 0 && result.output.find("Invalid job id") == std::string::npos)
    throw Error(ExitCode::kOutput, "squeue failed: " + one_line(result.output));
  return result.code == 0 && result.output.find_first_not_of(" \n") != std::string::npos;
}

void Submission::wait() const {
  const std::string ids = job_ids();
  for (int failures = 0;;) {
    std::this_thread::sleep_for(kQueuePollInterval);
    check_interrupt();
    try {
      if (!any_queued(ids)) break;
      failures = 0;
    } catch (const Error&) {  // the controller may be restarting
      if (++failures > kMaxFailedPolls) throw;
    }
  }
  std::string missing;
  size_t count = 0;
  if (is_finished(plan_, true)) {
    if (!config_.quiet)
      std::printf("%s is done\n", printable(plan_.path(plan_.steps.back().output)).c_str());
    return;
  }
  for (const PlanStep& step : plan_.steps) {
    if (output_state(plan_, step, plan_.path(step.output), false) == OutputState::kValid) continue;
    if (count++ < 3) missing += (missing.empty() ? "" : ", ") + step.name;
  }
  throw Error(ExitCode::kOutput, "the jobs ended, but " + std::to_string(count) +
                                     " steps of the plan are not done, first " + missing +
                                     ": see " + plan_.path("logs/") +
                                     ", then submit again to run only the missing steps");
}

void report_interrupted(const std::string& ids) {
  if (ids.empty()) {
    std::fprintf(stderr, "svdag: stopped; no job was submitted\n");
    return;
  }
  report_queued("stopped; ", ids);
}

}  // namespace

void submit_slurm(const Plan& plan, const SubmitConfig& config) {
  Submission submission(plan, config);
  try {
    submission.run();
  } catch (const Interrupted&) {
    report_interrupted(submission.job_ids());
    throw;
  }
}

}  // namespace svdag
