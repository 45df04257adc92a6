// `svdag build --batch LIST.json`: many bakes, one after the other, and one report.
//
// The list is an array of objects. Their keys are the options of `svdag build` without dashes, and
// "scene": a path or several. Each object becomes a command line and is understood as that, all of
// them before the first is baked. What the command line of the batch says holds for bakes that do
// not say otherwise; what cannot hold for several bakes is refused.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "builder/commands/command_files.h"
#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/json_text.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// A command line can leave an option out, but not take back what holds for all bakes.
void refuse_to_take_back(const std::string& key, const BuildCommandConfig& batch) {
  if (std::find(batch.given.begin(), batch.given.end(), "--" + key) != batch.given.end())
    fail_usage("\"" + key + "\": false does not take back the --" + key +
               " beside --batch, which is for all bakes: leave one of them out");
}

// The command line of one object.
std::vector<std::string> arguments_of(const Json& job, const BuildCommandConfig& batch) {
  std::vector<std::string> scene, options;
  const auto add = [&](const std::string& key, const Json& one) {
    if (one.is_structured() || one.is_null())
      fail_usage("\"" + key + "\" is no text, number or flag");
    if (key.size() == 1) fail_usage("\"" + key + "\": give the long name of the option");
    if (key == "scene") {
      scene.push_back(text_of(one));
    } else if (one.is_boolean()) {
      one.get<bool>() ? options.push_back("--" + key) : refuse_to_take_back(key, batch);
    } else if (const std::string text = text_of(one); text.empty()) {
      options.insert(options.end(), {"--" + key, text});  // behind "=" it would be the next word
    } else {
      options.push_back("--" + key + "=" + text);
    }
  };
  for (const auto& [key, value] : job.items()) {  // never copied: a copy of a deep one is recursive
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

// What the command line of the batch says of each bake; what it says of none is an Error.
BuildCommandConfig defaults_of(const BuildCommandConfig& batch) {
  const BuildConfig& build = batch.build;
  if (!build.scene.paths.empty())
    fail_usage("--batch: scenes stand in the list: leave " + build.scene.paths.front() + " out");
  if (!build.output.empty()) fail_usage("--batch: outputs stand in the list: leave --output out");
  if (batch.shard != 0) fail_usage("--batch: a list has no shards: leave --shard out");
  if (build.part) fail_usage("--batch: parts stand in the list: leave --part out");
  BuildCommandConfig defaults = batch;
  defaults.batch.clear();
  defaults.report.clear();
  defaults.keep_going = defaults.dry_run = false;
  return defaults;
}

std::string place(const BuildCommandConfig& batch, size_t job) {
  return batch.batch + ": bake " + std::to_string(job + 1) + ": ";
}

Json read_list(const std::string& path) {
  constexpr uint64_t kMost = uint64_t(64) << 20;
  const File file = File::open_read(path);
  if (file.size() > kMost) fail_input(path, "is too large for a list of bakes");
  std::string text(file.size(), ' ');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  try {
    Json list = Json::parse(text);
    if (list.is_array()) return list;
  } catch (const Json::parse_error& error) {
    throw Error(ExitCode::kBadInput, "is no JSON from there on", path, error.byte);
  } catch (const Json::exception&) {
    fail_input(path, "has a number that is too large");
  }
  fail_input(path, "is no list of bakes: a JSON array of objects");
}

}  // namespace

std::vector<BuildCommandConfig> bakes_of_batch(const BuildCommandConfig& batch) {
  const BuildCommandConfig defaults = defaults_of(batch);
  std::vector<BuildCommandConfig> jobs;
  for (const Json& job : read_list(batch.batch)) {
    const std::string where = place(batch, jobs.size());
    if (!job.is_object()) fail_usage(where + "is no object");
    try {
      jobs.push_back(batch.parse(arguments_of(job, batch), defaults));
    } catch (const Error& error) {
      fail_usage(where + error.what());
    }
  }
  return jobs;
}

namespace {

// No bake may write what the list, another bake or itself reads or writes, in whatever order.
void refuse_overwriting(const BuildCommandConfig& batch,
                        const std::vector<BuildCommandConfig>& jobs) {
  CommandFiles files;
  files.read(batch.batch);
  const auto replaces = [](const BuildCommandConfig& job) {
    return name_exists(job.build.output) || name_exists(job.report);
  };
  const bool buffers = replaces(batch) || std::any_of(jobs.begin(), jobs.end(), replaces);
  for (const BuildCommandConfig& job : jobs) {
    files.read(job.build.scene.paths);
    if (!buffers) continue;
    try {
      files.read_buffers(job.build.scene, job.build.memory);
    } catch (const Error&) {  // the bake will say so
    }
  }
  for (size_t i = 0; i < jobs.size(); ++i) {
    try {
      for (const std::string& output : outputs_of(jobs[i])) files.write(output);
      refuse_foreign_name(jobs[i].build.output);
    } catch (const Error& error) {
      fail_usage(place(batch, i) + error.what());
    }
  }
  if (!batch.report.empty()) files.write(batch.report);
}

struct Outcome {
  ExitCode code = ExitCode::kOk;
  std::string error;
  std::string report;
};

Outcome run(const BuildCommandConfig& job, const BuildCommandConfig& batch) {
  Outcome outcome;
  try {
    if (batch.dry_run) {
      run_dry(job);
    } else {
      bake_scene(job, &outcome.report);
    }
  } catch (Interrupted& interrupted) {
    if (job.build.unfinished == Unfinished::kRestart)
      interrupted.how = batch.build.unfinished == Unfinished::kRestart
                            ? kResumeForRestart
                            : "stopped; without \"restart\" in the list, the same command with "
                              "--resume continues";
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
    std::fprintf(stderr, "svdag: %s: %s\n", job.build.output.c_str(), outcome.error.c_str());
  return outcome;
}

void write_report(AtomicFile* report, size_t bakes, const Json& done) {
  report->append(json_text(Json{{"svdag", SVDAG_VERSION}, {"bakes", bakes}, {"done", done}}, 2) +
                 "\n");
  report->commit();
}

}  // namespace

int run_batch(const BuildCommandConfig& config) {
  const std::vector<BuildCommandConfig> jobs = bakes_of_batch(config);
  refuse_overwriting(config, jobs);
  std::optional<AtomicFile> report;  // opened before there is work to lose
  if (!config.report.empty()) report.emplace(config.report);
  Json done = Json::array();
  ExitCode first = ExitCode::kOk;
  size_t failed = 0;
  for (const BuildCommandConfig& job : jobs) {
    if (first != ExitCode::kOk && !config.keep_going) break;
    Outcome outcome;
    try {
      outcome = run(job, config);
    } catch (const Interrupted&) {
      if (report) write_report(&*report, jobs.size(), done);
      throw;
    }
    Json entry = {{"output", job.build.output}, {"exit", int(outcome.code)}};
    if (!outcome.error.empty()) entry["error"] = outcome.error;
    if (!outcome.report.empty()) entry["report"] = Json::parse(outcome.report);
    done.push_back(std::move(entry));
    failed += outcome.code != ExitCode::kOk;
    if (first == ExitCode::kOk) first = outcome.code;
  }
  if (report) write_report(&*report, jobs.size(), done);
  if (!config.output.quiet)
    std::printf("%zu of %zu %s, %zu failed\n", done.size() - failed, jobs.size(),
                config.dry_run ? "predicted" : "baked", failed);
  return int(first);
}

}  // namespace svdag
