// `svdag colour`: adds the colours of a scene to the file that was built of it.
#include <cstdio>

#include "builder/colours/colour_file.h"
#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/dag/colours/colour_writer.h"
#include "io/units.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {

int run(const ColourCommand& config) {
  const ColourFileConfig& colours = config.colours;
  CommandFiles files({colours.file});
  files.read(colours.scene.paths);
  read_buffers(colours.scene, colours.memory, &files);
  files.write(colours.output);
  require_dag_name(colours.output, false);
  AtomicFile::check(colours.output, config.output.no_clobber);
  ParallelExecutor executor(threads_or_all(config.threads));
  Progress progress(config.output.mode());
  Header header;
  const ColourPassReport report = colour_file(
      colours,
      [&](const DagFile& file, int level, const CubeColourSource& source, const WorkRoom& room) {
        header = write_coloured(file, {uint32_t(level), config.error}, source, colours.output, room,
                                &executor);
      },
      &executor, &progress);
  if (config.output.quiet) return int(ExitCode::kOk);
  const uint64_t bytes = header.chunks_bytes + header.directory_bytes;
  std::printf("%s: %s colours down to level %u, %s", printable(colours.output).c_str(),
              format_count(header.colour_count).c_str(), header.colour_level,
              format_bytes(bytes).c_str());
  if (header.colour_count > 0)
    std::printf(" (%.3g bits each)", 8 * double(bytes) / double(header.colour_count));
  if (report.texels_per_cube > 0) std::printf(", a cube spans %.2g texels", report.texels_per_cube);
  std::printf("\n");
  print_scene_notes(report.scene);
  std::printf("  colour hash %s\n", to_hex(header.colour_hash).c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
