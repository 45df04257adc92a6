#include "builder/commands/batch_record.h"

#include <nlohmann/json.hpp>

#include "builder/run/content_hash.h"
#include "io/json.h"
#include "streaming/error.h"
#include "streaming/file/file.h"

namespace svdag {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint64_t kMaxReportBytes = uint64_t(256) << 20;
constexpr int kMaxDepth = 16;  // of reports; json_text() recurses

}  // namespace

BatchRecord BatchRecord::read(const std::string& path) {
  BatchRecord record;
  if (!name_exists(path)) return record;
  const File file = File::open_read(path);
  if (file.size() > kMaxReportBytes) return record;
  const std::string text = file.text();
  const auto limit_depth = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) throw Error(ExitCode::kBadInput, "is nested too deeply");
    return true;
  };
  try {
    const Json json = Json::parse(text, limit_depth);
    for (const Json& bake : json.at("done")) {
      if (bake.at("exit") != 0) continue;
      const Json& report = bake.at("report");
      record.entries_[bake.at("output")] = {report.at("description_hash"),
                                            report.at("content_hash"), json_text(report)};
    }
  } catch (const Json::exception&) {
    return {};
  } catch (const Error&) {
    return {};
  }
  return record;
}

std::optional<std::string> BatchRecord::report_if_up_to_date(const BakeCommand& job) const {
  const auto found = entries_.find(job.build.output);
  if (found == entries_.end() || !name_exists(job.build.output)) return {};
  if (!job.report.empty() && !name_exists(job.report)) return {};
  const Entry& entry = found->second;
  try {
    if (content_hash_of(job.build.output, false) != entry.content_hash) return {};
    if (description_hash_of(job.build) != entry.description_hash) return {};
  } catch (const Error&) {  // the bake reports it
    return {};
  }
  return entry.report;
}

}  // namespace svdag
