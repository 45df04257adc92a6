// `svdag build --batch LIST.json`: runs a list of bakes, one at a time, with one report.
//
// The list is an array of objects. Their keys are the options of `svdag build` without dashes, and
// "scene", one or more paths. Each object becomes a command line; all are parsed before the first
// bake. Options given with --batch are defaults for every bake in the list; options that
// cannot apply to several bakes are rejected.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "builder/commands/command_files.h"
#include "builder/commands/options.h"
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

// Rejects "FLAG": false if --FLAG was given for all bakes: a bake cannot switch it off.
void reject_false(const std::string& key, const BatchCommand& batch) {
  if (batch.given.contains("--" + key))
    fail_usage("\"" + key + "\": false cannot switch off the --" + key +
               " given with --batch: leave one of them out");
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
  std::string text(file.size(), ' ');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  try {
    Json list = Json::parse(text);
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
      files.read_buffers(job.build.scene, job.build.memory);
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
};

Outcome bake(const BakeCommand& job, const BatchCommand& batch) {
  Outcome outcome;
  try {
    if (batch.dry_run) {
      predict({job.build, job.threads, job.output});
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
    std::fprintf(stderr, "svdag: %s: %s\n", job.build.output.c_str(), outcome.error.c_str());
  return outcome;
}

void write_report(AtomicFile* report, size_t bakes, const Json& done) {
  report->append(json_text(Json{{"svdag", SVDAG_VERSION}, {"bakes", bakes}, {"done", done}}, 2) +
                 "\n");
  report->commit();
}

}  // namespace

int run(const BatchCommand& config) {
  const std::vector<BakeCommand> jobs = bakes_of(config);
  reject_overwriting(config, jobs);
  std::optional<AtomicFile> report;  // created first: a bad path fails before any work
  if (!config.report.empty()) report.emplace(config.report);
  Json done = Json::array();
  ExitCode first = ExitCode::kOk;
  size_t failed = 0, skipped = 0;
  for (const BakeCommand& job : jobs) {
    if (first != ExitCode::kOk && !config.keep_going) break;
    if (job.output.no_clobber && name_exists(job.build.output)) {
      ++skipped;
      if (!job.output.quiet) std::printf("%s: already exists, skipped\n", job.build.output.c_str());
      continue;
    }
    Outcome outcome;
    try {
      outcome = bake(job, config);
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
  if (!config.defaults.output.quiet)
    std::printf("%zu of %zu %s, %zu failed%s\n", done.size() - failed, jobs.size(),
                config.dry_run ? "predicted" : "baked", failed,
                skipped > 0 ? (", " + std::to_string(skipped) + " skipped").c_str() : "");
  return int(first);
}

}  // namespace svdag
