// `svdag edit A.svdag [B.svdag] -o OUT.svdag`.
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

void check_output(const EditConfig& edit, bool no_clobber) {
  CommandFiles files({edit.first});
  if (edit.second) files.read(*edit.second);
  files.write(edit.output);
  require_dag_name(edit.output, false);
  AtomicFile::check(edit.output, no_clobber);
}

void check_operations(const EditConfig& edit) {
  if (edit.second && !edit.operation)
    fail_usage(*edit.second + ": choose --union, --intersection or --difference");
  if (!edit.second && edit.operation)
    fail_usage("a union, intersection or difference needs a second .svdag");
  if (edit.selection.level && edit.second)
    fail_usage("--level: coarsen the result in a second edit");
  if (!edit.second && edit.selection.is_everything())
    fail_usage(
        "nothing to do: give --level, --bounds, --layer, or a second .svdag and an operation");
}

}  // namespace

int run(const EditCommand& config) {
  check_operations(config.edit);
  check_output(config.edit, config.output.no_clobber);
  ParallelExecutor executor(threads_or_all(config.threads));
  const ImportReport r = edit(config.edit, &executor);
  for (const std::string& path : r.dropped_colours) report_dropped_colours(path);
  if (config.output.json)
    std::fputs(report_json(r, config.edit.output).c_str(), stdout);
  else if (!config.output.quiet)
    std::printf("%s: %s^3, %s voxels%s, %s nodes, %s\n  content hash %s\n",
                printable(config.edit.output).c_str(),
                format_resolution(uint64_t(r.grid.resolution())).c_str(),
                format_count(r.voxels).c_str(), layers_text(r).c_str(),
                format_count(r.nodes).c_str(), format_bytes(r.file_bytes).c_str(),
                r.content_hash.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
