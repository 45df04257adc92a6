#include "verify/commands/check.h"
#include "io/pack/unpack.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "io/dag/dag_file.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/printable.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

void print_json(const DagFile& file, const IntegrityReport& report) {
  const Header& h = file.header();
  const std::string hash = to_hex(h.content_hash);
  const nlohmann::json json = {{"command", "check"},      {"file", file.path()},
                               {"ok", report.sound()},    {"defects", report.defects},
                               {"voxels", report.voxels}, {"nodes", report.nodes},
                               {"content_hash", hash},    {"bytes", file.header().file_bytes}};
  std::printf("%s\n", json_text(json).c_str());
}

void print_text(const DagFile& file, const IntegrityReport& report) {
  uint64_t nodes = 0;
  for (const uint64_t n : report.nodes) nodes += n;
  std::printf("grid    %s\n", describe_grid(file).c_str());
  std::printf("bytes   %s in %s blocks, all checksums match\n",
              format_count(file.header().file_bytes).c_str(),
              format_count(file.header().checksum_bytes / 8).c_str());
  std::printf("nodes   %s on %zu levels, %s of them bricks\n", format_count(nodes).c_str(),
              report.nodes.size(), format_count(report.nodes.back()).c_str());
  std::printf("voxels  %s\n", format_count(report.voxels).c_str());
  for (const std::string& defect : report.defects)
    std::printf("defect  %s\n", printable(defect).c_str());
  std::printf(
      report.sound() ? "ok: sound, in canonical order and minimal\n" : "not ok: %zu defects\n",
      report.defects.size());
}

}  // namespace

int run(const CheckConfig& config) {
  const Stopwatch stopwatch(config.common);
  Progress progress(config.common.progress);
  progress.phase("checksums", 0);
  const DagFile file = open_dag(config.file);
  progress.phase("order and minimality", 0);
  MemoryBudget budget(memory_or_default(0));
  const IntegrityReport report = inspect_file(file, temporary_room(&budget));
  progress.finish();
  if (config.common.json) {
    print_json(file, report);
  } else if (!config.common.quiet) {
    print_text(file, report);
  }
  return int(report.sound() ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
