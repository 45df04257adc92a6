// `svdag convert A.svdag -o B.svdag`: another layout, or a part of a file.
#include <cstdio>

#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/dag/graph/select.h"
#include "io/dag/open_dag.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {

int run(const ConvertCommand& config) {
  const std::string& path = config.output_path;
  CommandFiles({config.file}).write(path);
  require_dag_name(path, false);
  AtomicFile::check(path, config.output.no_clobber);
  MemoryBudget budget(memory_or_default(config.memory));
  const WorkRoom room{&budget, config.scratch.empty() ? folder_of(path) : config.scratch};
  const DagFile file = open_dag(config.file, {}, &room);
  const uint64_t before = File::open_read(config.file).size();
  const Header header = write_selection(file, config.selection, path, room);
  if (!config.output.quiet)
    std::printf("%s: %s, %s, %.1f %% of %s\n  content hash %s\n", printable(path).c_str(),
                layout_name(config.selection.layout), format_bytes(header.file_bytes).c_str(),
                100 * double(header.file_bytes) / double(before), printable(config.file).c_str(),
                to_hex(header.content_hash).c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
