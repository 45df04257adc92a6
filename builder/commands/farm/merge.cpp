#include <cstdio>

#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

void check_run_files(const MergeRunsConfig& config) {
  CommandFiles files;
  for (const std::string& run : config.runs) {
    if (!files.read(run)) fail_usage(run + " is given twice");
  }
  files.write(config.output);
  require_dag_name(config.output);
}

void print_summary(const MergeCommand& config, const MergeRunsReport& r) {
  uint64_t nodes = 0;
  for (const uint64_t n : r.nodes) nodes += n;
  std::printf("%s: %s^3, %s (%s), %s, %s, %s, content %s\n", printable(config.merge.output).c_str(),
              format_resolution(uint64_t(r.grid.resolution())).c_str(),
              format_count(config.merge.runs.size(), "run").c_str(),
              format_bytes(r.runs_bytes).c_str(), format_count(r.voxels, "voxel").c_str(),
              format_count(nodes, "node").c_str(), format_bytes(r.file_bytes).c_str(),
              r.content_hash.c_str());
  if (!config.output.verbose) return;
  std::printf("  seconds: check %.2f, merge %.2f, write %.2f\n", r.seconds.check, r.seconds.merge,
              r.seconds.write);
  std::printf("  scratch: %s written; memory: %s counted, %s resident\n",
              format_bytes(r.scratch_written).c_str(), format_bytes(r.peak_counted).c_str(),
              format_bytes(peak_resident_bytes()).c_str());
}

}  // namespace

int run(const MergeCommand& config) {
  reject_plans(config.merge.runs);
  if (config.merge.output.empty()) fail_usage("--output: the output has no name");
  check_run_files(config.merge);
  AtomicFile::check(config.merge.output);
  ParallelExecutor executor(threads_or_all(config.threads));
  Progress progress(config.output.mode());
  const MergeRunsReport report = merge_runs(config.merge, &executor, &progress);
  if (!config.output.quiet) print_summary(config, report);
  return int(ExitCode::kOk);
}

}  // namespace svdag
