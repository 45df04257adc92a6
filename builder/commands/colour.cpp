// `svdag colour`: adds the colours of a scene to the file that was built of it.
#include <cstdio>

#include "builder/colour_file.h"
#include "builder/commands/command_scene.h"
#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "streaming/file/atomic_file.h"
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
  const ColourReport report = colour_file(colours, &executor, &progress);
  if (config.output.quiet) return int(ExitCode::kOk);
  std::printf("%s: ", printable(colours.output).c_str());
  print_colours(report);
  print_scene_notes(report.scene);
  print_colour_hash(report);
  if (colours.unfinished == Unfinished::kResume && !report.resumed)
    print_nothing_to_resume(colours.output, colours.scratch);
  return int(ExitCode::kOk);
}

}  // namespace svdag
