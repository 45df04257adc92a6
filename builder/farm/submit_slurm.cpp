#include "builder/farm/submit_slurm.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "builder/farm/process.h"
#include "builder/farm/receipt.h"
#include "builder/farm/shell.h"
#include "streaming/atomic_file.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kArray = 1000;    // tasks; Slurm's own limit is 1001 unless configured
constexpr double kTimeFactor = 4;  // of the predicted seconds, which are those of another machine
constexpr uint64_t kLeastMinutes = 10;
constexpr uint64_t kMiB = uint64_t(1) << 20;
constexpr auto kPoll = std::chrono::milliseconds(500);
constexpr int kPatience = 120;  // polls that squeue may fail for in a row

// The steps of one sbatch.
struct Job {
  std::string name;
  std::vector<size_t> steps;  // an array if they are shards, else one merge
  std::string script;         // its path
  uint64_t memory = 0;
  size_t threads = 1;
  double seconds = 0;
  std::string id;  // once submitted
};

Answer ask_sbatch(const std::vector<std::string>& command) {
  try {
    return ask_process(command);
  } catch (const Error& error) {
    fail_usage(std::string(error.what()) + ": is Slurm installed here?");
  }
}

class Submission {
 public:
  Submission(const Plan& plan, const SlurmConfig& config) : plan_(plan), config_(config) {}

  void run() {
    collect();
    if (jobs_.empty()) {
      if (!config_.quiet) std::printf("every step of the plan is done\n");
      return;
    }
    for (Job& job : jobs_) submit(&job);
    if (config_.wait) wait();
  }

 private:
  void collect();
  void add(size_t step, Job* job) const;
  void submit(Job* job);
  std::string script_of(const Job& job) const;
  std::string dependencies_of(const Job& job) const;
  void wait() const;
  bool any_queued(const std::string& ids) const;

  const Plan& plan_;
  const SlurmConfig& config_;
  std::vector<Job> jobs_;
  std::map<size_t, std::string> ids_;  // of the steps that were submitted: "12" or "12_3"
};

void Submission::collect() {
  size_t first = 0;  // shard of the current array
  for (size_t i = 0; i < plan_.steps.size(); ++i) {
    const PlanStep& step = plan_.steps[i];
    if (state_of(plan_, step, plan_.path(step.output), false) == OutputState::kValid) continue;
    const bool joins = step.is_shard() && !jobs_.empty() && i < first + kArray;
    if (!joins) {
      first = i / kArray * kArray;
      jobs_.emplace_back();
      jobs_.back().name = step.is_shard() ? "shards-" + std::to_string(first + 1) : step.name;
    }
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

// One step, by the task of the array that runs it.
std::string Submission::script_of(const Job& job) const {
  const PlanStep& step = plan_.steps[job.steps.front()];
  std::vector<std::string> words = plan_.command(step);
  if (step.is_shard()) words.pop_back();  // the number
  std::string command = shell_word(config_.program.empty() ? own_program() : config_.program);
  for (const std::string& word : words) command += " " + shell_word(word);
  if (step.is_shard())
    command += " \"$((SLURM_ARRAY_TASK_ID + " +
               std::to_string(job.steps.front() / kArray * kArray) + "))\"";
  if (!config_.scratch.empty()) command += " --scratch " + shell_word(config_.scratch);
  return "#!/bin/sh\n" + command +
         "\n"
         "code=$?\n"
         "# What may pass (disk, memory, a signal) is tried again; the rest would fail again.\n"
         "case $code in\n"
         "  4 | 5 | 12[89] | 1[3-9]? | 2[0-9][0-9])\n"
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

void Submission::submit(Job* job) {
  job->script = plan_.path("logs/" + job->name + ".sh");
  AtomicFile file(job->script);
  file.append(script_of(*job));
  file.commit();
  const bool array = plan_.steps[job->steps.front()].is_shard();
  const uint64_t minutes = std::max(kLeastMinutes, uint64_t(kTimeFactor * job->seconds / 60) + 1);
  std::vector<std::string> command = {
      "sbatch",
      "--parsable",
      "--requeue",
      "--open-mode=append",
      "--job-name=" + job->name,
      "--output=" + plan_.path("logs/") + (array ? "shard-%a.slurm.log" : job->name + ".slurm.log"),
      "--mem=" + std::to_string((job->memory + kMiB - 1) / kMiB) + "M",
      "--cpus-per-task=" + std::to_string(job->threads),
      "--time=" + std::to_string(minutes)};
  if (array) {
    std::string tasks;
    for (const size_t i : job->steps)
      tasks += (tasks.empty() ? "" : ",") + std::to_string(i % kArray + 1);
    command.push_back("--array=" + tasks);
  }
  const std::string after = dependencies_of(*job);
  if (!after.empty()) {
    command.push_back("--dependency=afterok" + after);
    command.push_back("--kill-on-invalid-dep=yes");
  }
  command.insert(command.end(), config_.options.begin(), config_.options.end());
  command.push_back(job->script);
  const Answer answer = ask_sbatch(command);
  if (answer.code != 0) fail_usage("sbatch refused " + job->name + ": " + one_line(answer.output));
  const std::string line =
      last_line_of(answer.output);  // ID[;CLUSTER], behind what sbatch warns of
  job->id = line.substr(0, line.find(';'));
  for (const size_t i : job->steps)
    ids_[i] = array ? job->id + "_" + std::to_string(i % kArray + 1) : job->id;
  if (!config_.quiet)
    std::printf("%s: job %s%s%s\n", job->name.c_str(), job->id.c_str(),
                after.empty() ? "" : " after ", after.empty() ? "" : after.c_str() + 1);
  std::fflush(stdout);
}

// Whether one of the jobs is still queued or runs.
bool Submission::any_queued(const std::string& ids) const {
  const Answer answer =
      ask_process({"squeue", "--noheader", "--array", "--jobs=" + ids, "--format=%T"});
  // squeue knows nothing of jobs that ended a while ago, and calls them invalid.
  if (answer.code != 0 && answer.output.find("Invalid job id") == std::string::npos)
    throw Error(ExitCode::kOutput, "squeue failed: " + one_line(answer.output));
  return answer.code == 0 && answer.output.find_first_not_of(" \n") != std::string::npos;
}

void Submission::wait() const {
  std::string ids;
  for (const Job& job : jobs_) ids += (ids.empty() ? "" : ",") + job.id;
  for (int failures = 0;;) {
    std::this_thread::sleep_for(kPoll);
    check_interrupt();
    try {
      if (!any_queued(ids)) break;
      failures = 0;
    } catch (const Error&) {  // a controller that restarts answers a while later
      if (++failures > kPatience) throw;
    }
  }
  std::string missing;
  size_t count = 0;
  for (const PlanStep& step : plan_.steps) {
    if (state_of(plan_, step, plan_.path(step.output), false) == OutputState::kValid) continue;
    if (count++ < 3) missing += (missing.empty() ? "" : ", ") + step.name;
  }
  if (count == 0) {
    if (!config_.quiet) std::printf("%s is done\n", plan_.path(plan_.steps.back().output).c_str());
    return;
  }
  throw Error(ExitCode::kOutput, "the jobs ended, but " + std::to_string(count) +
                                     " steps of the plan were not done, first " + missing +
                                     ": see " + plan_.path("logs/") +
                                     "; submitting again does only what is missing");
}

}  // namespace

void submit_slurm(const Plan& plan, const SlurmConfig& config) {
  Submission(plan, config).run();
}

}  // namespace svdag
