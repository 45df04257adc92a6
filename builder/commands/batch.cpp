// `svdag batch LIST.json`: runs a list of bakes, with one report. With --parallel N, N
// bakes run at once, each with a share of 1/N of memory and threads.
//
// The list is an array of objects. Their keys are the options of `svdag build` without dashes, and
// "scene", one or more paths. Each object becomes a command line; all are parsed before the first
// bake. The other options of the command line are defaults for every bake in the list. Bakes that
// the previous --report shows to be up to date are skipped.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "builder/commands/batch_record.h"
#include "builder/commands/command_scene.h"
#include "builder/commands/options.h"
#include "builder/run/bake_output.h"
#include "io/json.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Rejects "FLAG": false if --FLAG was given for all bakes: a bake cannot switch it off.
void reject_false(const std::string& key, const BatchCommand& batch) {
  if (batch.flags.contains(key))
    fail_usage("\"" + key + "\": false cannot switch off the --" + key +
               " of the command line: leave one of them out");
}

// The command line of one object.
std::vector<std::string> arguments_of(const Json& job, const BatchCommand& batch) {
  std::vector<std::string> scene, options;
  const auto add = [&](const std::string& key, const Json& one) {
    if (one.is_structured() || one.is_null())
      fail_usage("\"" + key + "\" must be a string, number or boolean");
    if (key.size() == 1) fail_usage("\"" + key + "\": use the long name of the option");
    if (key == "scene") {
      scene.push_back(text_of(one));
    } else if (one.is_boolean()) {
      one.get<bool>() ? options.push_back("--" + key) : reject_false(key, batch);
    } else if (const std::string text = text_of(one); text.empty()) {
      options.insert(options.end(), {"--" + key, text});  // "--KEY=" would take the next word
    } else {
      options.push_back("--" + key + "=" + text);
    }
  };
  for (const auto& [key, value] : job.items()) {  // no copies: copying deep JSON recurses
    if (value.is_array()) {
      for (const Json& one : value) add(key, one);
    } else {
      add(key, value);
    }
  }
  options.push_back("--");
  options.insert(options.end(), scene.begin(), scene.end());
  return options;
}

std::string bake_prefix(const BatchCommand& batch, size_t job) {
  return batch.list + ": bake " + std::to_string(job + 1) + ": ";
}

Json read_list(const std::string& path) {
  constexpr uint64_t kMaxListBytes = uint64_t(64) << 20;
  const File file = File::open_read(path);
  if (file.size() > kMaxListBytes)
    fail_input(path, "is too large for a list of bakes (max 64 MiB)");
  try {
    Json list = Json::parse(file.text());
    if (list.is_array()) return list;
  } catch (const Json::parse_error& error) {
    throw Error(ExitCode::kBadInput, "is not valid JSON", path, error.byte);
  } catch (const Json::exception&) {
    fail_input(path, "has a number that is too large");
  }
  fail_input(path, "is not a list of bakes: must be a JSON array of objects");
}

}  // namespace

std::vector<BakeCommand> bakes_of(const BatchCommand& batch) {
  std::vector<BakeCommand> jobs;
  for (const Json& job : read_list(batch.list)) {
    const std::string where = bake_prefix(batch, jobs.size());
    if (!job.is_object()) fail_usage(where + "is not an object");
    try {
      jobs.push_back(parse_bake(arguments_of(job, batch), batch.defaults));
    } catch (const Error& error) {
      fail_usage(where + error.what());
    }
  }
  return jobs;
}

namespace {

// Rejects a bake that would overwrite the list, an input of any bake, or an output of another.
void reject_overwriting(const BatchCommand& batch, const std::vector<BakeCommand>& jobs) {
  CommandFiles files;
  files.read(batch.list);
  const auto replaces = [](const BakeCommand& job) {
    return name_exists(job.build.output) || name_exists(job.report);
  };
  const bool buffers = name_exists(batch.report) || std::any_of(jobs.begin(), jobs.end(), replaces);
  for (const BakeCommand& job : jobs) {
    files.read(job.build.scene.paths);
    if (!buffers) continue;
    try {
      read_buffers(job.build.scene, job.build.memory, &files);
    } catch (const Error&) {  // the bake reports it
    }
  }
  for (size_t i = 0; i < jobs.size(); ++i) {
    try {
      for (const std::string& output : outputs_of(jobs[i])) files.write(output);
      require_dag_name(jobs[i].build.output);
    } catch (const Error& error) {
      fail_usage(bake_prefix(batch, i) + error.what());
    }
  }
  if (!batch.report.empty()) files.write(batch.report);
}

struct Outcome {
  ExitCode code = ExitCode::kOk;
  std::string error;
  std::string report;
  std::optional<Prediction> predicted;
  bool up_to_date = false;
};

Outcome bake(const BakeCommand& job, const BatchCommand& batch) {
  Outcome outcome;
  try {
    if (batch.dry_run) {
      outcome.predicted = predict({job.build, job.threads, job.output});
    } else {
      outcome.report = bake_scene(job, true);
    }
  } catch (Interrupted& interrupted) {
    if (job.build.unfinished == Unfinished::kRestart &&
        batch.defaults.build.unfinished != Unfinished::kRestart)
      interrupted.resume_message =
          "stopped; to continue, remove \"restart\" from the list and repeat the command with "
          "--resume";
    throw;
  } catch (const Error& error) {
    outcome.code = error.code();
    outcome.error = error.what();
  } catch (const std::exception& error) {
    if (!is_lack_of_memory(error)) throw;
    outcome.code = ExitCode::kMemory;
    outcome.error = kNoMemory;
  }
  if (outcome.code != ExitCode::kOk)
    std::fprintf(stderr, "svdag: %s: %s\n", printable(job.build.output).c_str(),
                 printable(outcome.error).c_str());
  return outcome;
}

// Fails before the first bake if a scene cannot be opened or an output cannot be written. With
// --keep-going such a bake fails when its turn comes.
void check_files(const BatchCommand& batch, const std::vector<BakeCommand>& jobs) {
  for (size_t i = 0; i < jobs.size() && !batch.keep_going; ++i) {
    const BakeCommand& job = jobs[i];
    if (job.output.no_clobber && name_exists(job.build.output)) continue;
    try {
      for (const std::string& scene : job.build.scene.paths) File::open_read(scene);
      if (batch.dry_run) continue;
      for (const std::string& output : outputs_of(job)) AtomicFile::check(output, false);
    } catch (const Error& error) {
      throw Error(error.code(), bake_prefix(batch, i) + error.what());
    }
  }
}

// The jobs with a share of memory and threads each, so that `parallel` of them fit at once.
std::vector<BakeCommand> shared_jobs(const BatchCommand& batch, std::vector<BakeCommand> jobs) {
  if (batch.parallel == 1) return jobs;
  const uint64_t memory = memory_or_default(batch.defaults.build.memory) / batch.parallel;
  const size_t threads =
      std::max<size_t>(1, threads_or_all(batch.defaults.threads) / batch.parallel);
  for (BakeCommand& job : jobs) {
    job.build.memory = job.build.memory == 0 ? memory : std::min(job.build.memory, memory);
    job.threads = job.threads == 0 ? threads : std::min(job.threads, threads);
    job.output.progress = Progress::Mode::kOff;  // several lines would overwrite each other
  }
  return jobs;
}

// The bakes of a batch that were tried or up to date, in the order of the list.
class BatchRun {
 public:
  BatchRun(const BatchCommand& batch, const std::vector<BakeCommand>& jobs)
      : batch_(batch), jobs_(jobs), outcomes_(jobs.size()) {}

  // Looks for bakes that need not run. Before the first bake, so that a stopped run loses none.
  void find_up_to_date(const BatchRecord& record) {
    for (size_t i = 0; i < jobs_.size(); ++i) {
      const std::optional<std::string> report = record.report_if_up_to_date(jobs_[i]);
      if (!report) continue;
      outcomes_[i] = Outcome{ExitCode::kOk, "", *report, {}, true};
      if (!jobs_[i].output.quiet)
        std::printf("%s: up to date\n", printable(jobs_[i].build.output).c_str());
    }
  }

  // Bakes all jobs. Throws Interrupted; report_text() then has the finished ones.
  void run() {
    // One by one, predictions are not mixed.
    ParallelExecutor workers(batch_.dry_run ? 1 : batch_.parallel);
    try {
      workers.for_each(jobs_.size(), [this](size_t, size_t i) { run_job(i); });
    } catch (Interrupted& interrupted) {
      interrupted.resumable = resumable_;
      throw;
    }
  }

  ExitCode first_failure() const {
    for (const auto& outcome : outcomes_) {
      if (outcome && outcome->code != ExitCode::kOk) return outcome->code;
    }
    return ExitCode::kOk;
  }

  std::string report_text() const {
    Json done = Json::array();
    for (size_t i = 0; i < jobs_.size(); ++i) {
      if (!outcomes_[i]) continue;
      Json entry = {{"output", jobs_[i].build.output}, {"exit", int(outcomes_[i]->code)}};
      if (outcomes_[i]->up_to_date) entry["up_to_date"] = true;
      if (!outcomes_[i]->error.empty()) entry["error"] = outcomes_[i]->error;
      if (!outcomes_[i]->report.empty()) entry["report"] = Json::parse(outcomes_[i]->report);
      done.push_back(std::move(entry));
    }
    const Json report = {{"svdag", SVDAG_VERSION}, {"bakes", jobs_.size()}, {"done", done}};
    return json_text(report, 2) + "\n";
  }

  void print_summary() const {
    size_t good = 0, failed = 0, up_to_date = 0;
    for (const auto& outcome : outcomes_) {
      if (!outcome) continue;
      ++(outcome->up_to_date ? up_to_date : outcome->code == ExitCode::kOk ? good : failed);
    }
    const auto also = [](size_t count, const char* what) {
      return count > 0 ? ", " + std::to_string(count) + what : "";
    };
    std::printf("%zu of %zu %s, %zu failed%s%s\n", good, jobs_.size(),
                batch_.dry_run ? "predicted" : "baked", failed,
                also(up_to_date, " up to date").c_str(), also(skipped_, " skipped").c_str());
    if (batch_.dry_run && good > 1) print_totals();
  }

 private:
  // What the bakes take together: their files remain, and `parallel` of them run at once.
  void print_totals() const {
    double cpu = 0, seconds = 0;
    uint64_t output = 0;
    std::vector<uint64_t> scratch, memory;
    for (const auto& outcome : outcomes_) {
      if (!outcome || !outcome->predicted) continue;
      const Prediction& p = *outcome->predicted;
      cpu += p.cpu;
      seconds += p.seconds / double(batch_.parallel);
      output += p.output;
      scratch.push_back(p.scratch);
      memory.push_back(p.memory);
    }
    const auto at_once = [&](std::vector<uint64_t> bytes) {
      std::ranges::sort(bytes, std::greater());
      bytes.resize(std::min(bytes.size(), batch_.parallel));
      return format_bytes(std::accumulate(bytes.begin(), bytes.end(), uint64_t(0)));
    };
    std::printf(
        "  in all about %.2f CPU seconds, %.2f s; files of about %s, scratch of at most %s and "
        "memory of at most %s at once\n",
        cpu, seconds, format_bytes(output).c_str(), at_once(scratch).c_str(),
        at_once(memory).c_str());
  }

  void run_job(size_t i) {
    if (outcomes_[i] || (failed_ && !batch_.keep_going)) return;
    const BakeCommand& job = jobs_[i];
    if (job.output.no_clobber && name_exists(job.build.output)) {
      ++skipped_;
      if (!job.output.quiet)
        std::printf("%s: already exists, skipped\n", printable(job.build.output).c_str());
      return;
    }
    Outcome outcome;
    try {
      outcome = bake(job, batch_);
    } catch (const Interrupted& interrupted) {
      if (interrupted.resumable) resumable_ = true;
      throw;
    }
    if (outcome.code != ExitCode::kOk) failed_ = true;
    outcomes_[i] = std::move(outcome);
  }

  const BatchCommand& batch_;
  const std::vector<BakeCommand>& jobs_;
  std::vector<std::optional<Outcome>> outcomes_;  // of each job that was tried or up to date
  std::atomic<bool> failed_ = false;
  std::atomic<bool> resumable_ = false;  // an interrupted bake saved work
  std::atomic<size_t> skipped_ = 0;
};

}  // namespace

int run(const BatchCommand& config) {
  std::vector<BakeCommand> jobs = shared_jobs(config, bakes_of(config));
  if (config.json) {
    for (BakeCommand& job : jobs) job.output.quiet = true;
  }
  reject_overwriting(config, jobs);
  check_files(config, jobs);
  std::optional<AtomicFile> report;  // created first: a bad path fails before any work
  if (!config.report.empty()) report.emplace(config.report);
  const BatchRecord record = BatchRecord::read(config.report);
  const auto write_report = [&](const BatchRun& batch) {
    if (!report) return;
    report->append(batch.report_text());
    report->commit();
  };
  BatchRun batch(config, jobs);
  batch.find_up_to_date(record);
  try {
    batch.run();
  } catch (const Interrupted&) {
    write_report(batch);
    throw;
  }
  write_report(batch);
  if (config.json)
    std::fputs(batch.report_text().c_str(), stdout);
  else if (!config.defaults.output.quiet)
    batch.print_summary();
  return int(batch.first_failure());
}

}  // namespace svdag
