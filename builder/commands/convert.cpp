// `svdag convert`: another layout, or a part of a file; `svdag pack` and `svdag unpack`.
#include <cstdio>

#include "builder/commands/commands.h"
#include "builder/run/bake_output.h"
#include "io/dag/graph/select.h"
#include "io/dag/open_dag.h"
#include "io/dag/pack/pack.h"
#include "io/dag/pack/unpack.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {

void report_dropped_colours(const std::string& path) {
  std::fprintf(stderr, "svdag: %s: its colours are left out of the output\n",
               printable(path).c_str());
}

namespace {

void print_json(const Header& header, uint64_t file_bytes, const std::string& path) {
  ImportReport report = report_of(header);
  report.file_bytes = file_bytes;
  std::fputs(report_json(report, path).c_str(), stdout);
}

}  // namespace

int run(const ConvertCommand& config) {
  const std::string& path = config.output_path;
  CommandFiles({config.file}).write(path);
  require_dag_name(path, false);
  AtomicFile::check(path, config.output.no_clobber);
  MemoryBudget budget(memory_or_default(config.memory));
  const WorkRoom room{&budget, config.scratch.empty() ? folder_of(path) : config.scratch};
  const DagFile file = open_dag(config.file, {}, &room);
  const uint64_t before = File::open_read(config.file).size();
  Selection selection = config.selection;
  if (config.keeps_layout) selection.layout = Layout(file.header().layout);
  ParallelExecutor executor(available_processors());
  const Header header = write_selection(file, selection, path, room, &executor);
  if (file.has_colours() && !has_colours(header) && !selection.without_colours)
    report_dropped_colours(config.file);
  if (config.output.json)
    print_json(header, header.file_bytes, path);
  else if (!config.output.quiet)
    std::printf("%s: %s, %s, %.1f %% of %s\n  content hash %s\n", printable(path).c_str(),
                layout_name(selection.layout), format_bytes(header.file_bytes).c_str(),
                100 * double(header.file_bytes) / double(before), printable(config.file).c_str(),
                to_hex(header.content_hash).c_str());
  if (!config.output.quiet && !selection.palette.empty())
    std::printf("  %s\n", palette_text(selection.palette, file.layers()).c_str());
  return int(ExitCode::kOk);
}

int run(const PackCommand& config) {
  const std::string& path = config.output_path;
  CommandFiles({config.file}).write(path);
  if (!path.ends_with(".pack")) fail_usage(path + ": the output must end in .pack");
  AtomicFile::check(path, config.output.no_clobber);
  MemoryBudget budget(memory_or_default(config.memory));
  const WorkRoom room{&budget, folder_of(path)};
  ParallelExecutor executor(threads_or_all(config.threads));
  const DagFile plain = select(open_dag(config.file), config.selection, room, &executor);
  const uint64_t bytes = pack(plain, path, config.level, &budget, &executor);
  if (config.output.json)
    print_json(plain.header(), bytes, path);
  else if (!config.output.quiet)
    std::printf("%s: %s, %.1f %% of the plain %s\n  content hash %s\n", printable(path).c_str(),
                format_bytes(bytes).c_str(), 100 * double(bytes) / double(plain.bytes().size()),
                format_bytes(plain.bytes().size()).c_str(),
                to_hex(plain.header().content_hash).c_str());
  return int(ExitCode::kOk);
}

int run(const UnpackCommand& config) {
  const std::string& path = config.output_path;
  CommandFiles({config.file}).write(path);
  require_dag_name(path, false);
  AtomicFile::check(path, config.output.no_clobber);
  MemoryBudget budget(memory_or_default(config.memory));
  ParallelExecutor executor(threads_or_all(config.threads));
  const Header header = unpack_to(config.file, path, {&budget, folder_of(path)}, &executor);
  if (config.output.json)
    print_json(header, header.file_bytes, path);
  else if (!config.output.quiet)
    std::printf("%s: %s\n  content hash %s\n", printable(path).c_str(),
                format_bytes(header.file_bytes).c_str(), to_hex(header.content_hash).c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
