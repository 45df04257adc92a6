#include "io/dag/dag_file.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "verify/commands/commands.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

Verdict verdict_of(const DagFile& file, const IntegrityReport& report) {
  uint64_t nodes = 0;
  for (const uint64_t n : report.nodes) nodes += n;
  Verdict verdict = begin_verdict("check", file);
  verdict.for_people("grid", describe_grid(file));
  verdict.add(
      "bytes", "bytes", file.header().file_bytes,
      "in " + format_count(file.header().checksum_bytes / 8) + " blocks, all checksums match");
  verdict.add(
      "nodes", "nodes",
      shown(report.nodes, format_count(nodes) + " on " + std::to_string(report.nodes.size()) +
                              " levels, " + format_count(report.nodes.back()) + " of them bricks"));
  verdict.add("voxels", "voxels", report.voxels);
  verdict.add("defects", "defect", report.defects);
  verdict.add(
      "ok", "",
      shown(report.sound(), report.sound()
                                ? "ok: sound, in canonical order and minimal"
                                : "not ok: " + format_count(report.defects.size()) + " defects"));
  return verdict;
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
  return finish(config.common, verdict_of(file, report), report.sound());
}

}  // namespace svdag
