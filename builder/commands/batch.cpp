// `svdag build --batch LIST.json`: many bakes, one after the other, and one report.
//
// The list is an array of objects. Their keys are the options of `svdag build` without dashes, and
// "scene": a path or several. Each object becomes a command line and is understood as that, all of
// them before the first is baked. What the command line of the batch says of memory, threads, disk,
// cache and --sandbox holds for bakes that say nothing of it.
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "builder/commands/commands.h"
#include "streaming/atomic_file.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// The command line of one object.
std::vector<std::string> arguments_of(const Json& job) {
  std::vector<std::string> scene, options;
  const auto add = [&](const std::string& key, const Json& one) {
    if (one.is_structured() || one.is_null())
      fail_usage("\"" + key + "\" is no text, number or flag");
    if (key == "scene") {
      scene.push_back(text_of(one));
    } else if (one.is_boolean()) {
      if (one.get<bool>()) options.push_back("--" + key);
    } else {
      options.push_back("--" + key + "=" + text_of(one));
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

void inherit(const BuildCommandConfig& batch, BuildCommandConfig* job) {
  if (job->build.memory == 0) job->build.memory = batch.build.memory;
  if (job->build.scratch.empty()) job->build.scratch = batch.build.scratch;
  if (job->build.unfinished == Unfinished::kRefuse) job->build.unfinished = batch.build.unfinished;
  job->build.scene.sandbox |= batch.build.scene.sandbox;
  if (job->threads == 0) job->threads = batch.threads;
  if (job->cache.folder.empty()) job->cache = batch.cache;
  job->output = batch.output;
}

Json read_list(const std::string& path) {
  constexpr uint64_t kMost = uint64_t(64) << 20;
  const File file = File::open_read(path);
  if (file.size() > kMost) fail_input(path, "is too large for a list of bakes");
  std::string text(file.size(), ' ');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  const Json list = Json::parse(text, nullptr, false);
  if (!list.is_array()) fail_input(path, "is no list of bakes: a JSON array of objects");
  return list;
}

}  // namespace

std::vector<BuildCommandConfig> bakes_of_batch(const BuildCommandConfig& batch) {
  std::vector<BuildCommandConfig> jobs;
  std::set<std::string> outputs;
  for (const Json& job : read_list(batch.batch)) {
    const std::string where = batch.batch + ": bake " + std::to_string(jobs.size() + 1) + ": ";
    if (!job.is_object()) fail_usage(where + "is no object");
    try {
      jobs.push_back(batch.parse(arguments_of(job)));
    } catch (const Error& error) {
      fail_usage(where + error.what());
    }
    inherit(batch, &jobs.back());
    if (!outputs.insert(jobs.back().build.output).second)
      fail_usage(where + "has the output of another one, " + jobs.back().build.output);
  }
  return jobs;
}

namespace {

struct Outcome {
  ExitCode code = ExitCode::kOk;
  std::string error;
  std::string report;
};

Outcome run(const BuildCommandConfig& job) {
  Outcome outcome;
  try {
    bake_scene(job, &outcome.report);
  } catch (const Interrupted&) {
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

}  // namespace

int run_batch(const BuildCommandConfig& config) {
  const std::vector<BuildCommandConfig> jobs = bakes_of_batch(config);
  std::optional<AtomicFile> report;  // opened before there is work to lose
  if (!config.report.empty()) report.emplace(config.report);
  Json done = Json::array();
  ExitCode first = ExitCode::kOk;
  size_t failed = 0;
  for (const BuildCommandConfig& job : jobs) {
    if (first != ExitCode::kOk && !config.keep_going) break;
    const Outcome outcome = run(job);
    Json entry = {{"output", job.build.output}, {"exit", int(outcome.code)}};
    if (!outcome.error.empty()) entry["error"] = outcome.error;
    if (!outcome.report.empty()) entry["report"] = Json::parse(outcome.report);
    done.push_back(std::move(entry));
    failed += outcome.code != ExitCode::kOk;
    if (first == ExitCode::kOk) first = outcome.code;
  }
  if (report) {
    report->append(Json{{"svdag", SVDAG_VERSION}, {"bakes", jobs.size()}, {"done", done}}.dump(2) +
                   "\n");
    report->commit();
  }
  if (!config.output.quiet)
    std::printf("%zu of %zu baked, %zu failed\n", done.size() - failed, jobs.size(), failed);
  return int(first);
}

}  // namespace svdag
