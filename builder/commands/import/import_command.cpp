#include "builder/commands/import/import_command.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

#include "builder/commands/import/vdb.h"
#include "builder/run/bake_output.h"
#include "io/dag/format.h"
#include "io/dag/symvox_header.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/hashdag_colours.h"
#include "io/formats/dags/symvox.h"
#include "io/formats/dags/transform_dag.h"
#include "io/formats/voxels/binvox.h"
#include "io/formats/voxels/npz.h"
#include "io/formats/voxels/ply_points.h"
#include "io/formats/voxels/vox.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using GraphReader = std::unique_ptr<NodeGraph> (*)(const File&);
// How voxels are read; a format uses what it has.
struct VoxelReading {
  LayerTable* layers;  // null: --no-layers
  bool with_colours;
  int up;      // axis
  int levels;  // of -r; 0: not given
};
using VoxelReader = GridPlacement (*)(const File&, const VoxelSink&, const VoxelReading&);
using FileStart = std::string_view;  // the first bytes of a file

bool looks_like_symvox(const File& file, FileStart) {
  SymvoxHeader header;
  return read_symvox_header(file, &header);
}
bool looks_like_hashdag(const File& file, FileStart) {
  return file.path().ends_with(".dag.bin");
}
bool looks_like_transform_dag(const File&, FileStart start) {
  uint32_t magic = 0;
  std::memcpy(&magic, start.data(), std::min(start.size(), sizeof magic));
  return magic == kTransformDagMagic;
}
bool looks_like_npz(const File&, FileStart start) {
  return start.starts_with("PK\3\4") || start.starts_with("\x93NUMPY");
}
bool looks_like_binvox(const File&, FileStart start) {
  return start.starts_with("#binvox");
}
bool looks_like_vox(const File&, FileStart start) {
  return start.starts_with("VOX ");
}
bool looks_like_vdb(const File&, FileStart start) {
  return start.starts_with(" BDV") || start.starts_with("NanoVDB");
}

bool looks_like_ply(const File&, FileStart start) {
  return start.starts_with("ply\n") || start.starts_with("ply\r");
}

GridPlacement read_binvox_voxels(const File& file, const VoxelSink& sink, const VoxelReading&) {
  return read_binvox(file, sink);
}
GridPlacement read_npz_voxels(const File& file, const VoxelSink& sink, const VoxelReading& how) {
  return read_npz(file, sink, how.layers, how.with_colours);
}
GridPlacement read_vox_voxels(const File& file, const VoxelSink& sink, const VoxelReading& how) {
  return read_vox(file, sink, how.layers, how.with_colours, how.up);
}
GridPlacement read_ply_voxels(const File& file, const VoxelSink& sink, const VoxelReading& how) {
  return read_ply_points(file, sink, how.with_colours, how.levels);
}

struct FormatRow {
  const char* name;
  bool (*matches)(const File&, FileStart);
  GraphReader graph;  // at most one of the two readers is set; for OpenVDB, neither
  VoxelReader voxels;
};

// The only table of formats; those with a magic number come first.
constexpr FormatRow kFormats[] = {
    {"transform-dag", looks_like_transform_dag, read_transform_dag, nullptr},
    {"npz", looks_like_npz, nullptr, read_npz_voxels},
    {"binvox", looks_like_binvox, nullptr, read_binvox_voxels},
    {"vox", looks_like_vox, nullptr, read_vox_voxels},
    {"ply", looks_like_ply, nullptr, read_ply_voxels},
    {"vdb", looks_like_vdb, nullptr, nullptr},
    {"hashdag", looks_like_hashdag, read_hashdag, nullptr},
    {"symvox", looks_like_symvox, read_symvox, nullptr},
};

const FormatRow& choose(const ImportCommandConfig& config, const File& file) {
  std::array<char, 8> bytes{};
  const size_t size = file.read_some_at(0, std::as_writable_bytes(std::span(bytes)));
  const FileStart start(bytes.data(), size);
  if (size == sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0)
    fail_usage(config.file + ": is already a .svdag of this program");
  std::string names;
  for (const FormatRow& row : kFormats) {
    if (config.format.empty() ? row.matches(file, start) : config.format == row.name) return row;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  if (!config.format.empty())
    fail_usage("--format: unknown format \"" + config.format + "\": choose one of " + names);
  fail_input(config.file, "unknown file format: choose one with --format: " + names +
                              " (svdag build bakes scenes)");
}

// Rejects options of other formats, which this one would ignore.
void reject_options_of_other_formats(const ImportCommandConfig& config, const FormatRow& row) {
  const auto reject = [&](bool given, const char* option, const char* ending) {
    if (given)
      fail_usage(std::string(option) + ": only for " + ending + " files; " + config.file +
                 " is read as " + row.name);
  };
  const bool is_vdb = row.graph == nullptr && row.voxels == nullptr;
  reject(!is_vdb && !config.grid.empty(), "--grid", ".vdb");
  reject(!is_vdb && config.iso, "--iso", ".vdb");
  reject(row.voxels != read_vox_voxels && config.up, "--up", ".vox");
}

ImportReport import_as(const FormatRow& row, const File& file, const File* colours,
                       const ImportCommandConfig& config, const ImportConfig& import) {
  ParallelExecutor executor(threads_or_all(config.threads));
  if (row.graph != nullptr) {
    const std::unique_ptr<NodeGraph> graph = row.graph(file);
    if (colours == nullptr) return import_graph(graph.get(), nullptr, import, &executor);
    HashDagColours of_voxels(*colours);
    const VoxelColourSource source{colours->path(), of_voxels.count(),
                                   [&] { return of_voxels.next(); }};
    return import_graph(graph.get(), &source, import, &executor);
  }
  if (row.voxels != nullptr) {
    LayerTable layers;
    const auto read = [&](const VoxelSink& sink, const FullCubeSink&) {
      return row.voxels(file, sink,
                        {config.no_layers ? nullptr : &layers, !config.no_colours,
                         config.up.value_or(kDefaultVoxUp), import.levels});
    };
    return import_voxels(read, import, &executor, 0, &layers);
  }
  std::unique_ptr<VdbGrid> grid = read_vdb(config.file, config.grid, config.iso, config.sandbox);
  reject_needless_range(*grid, config.iso);
  const VdbVoxels voxels(std::move(grid), config.file);
  const auto read = [&](const VoxelSink& sink, const FullCubeSink& cubes) {
    return voxels.read(sink, cubes);
  };
  return import_voxels(read, import, &executor, voxels.count());
}

}  // namespace

std::vector<std::string> import_formats() {
  std::vector<std::string> names;
  for (const FormatRow& row : kFormats) names.emplace_back(row.name);
  return names;
}

int run(const ImportCommandConfig& config) {
  CommandFiles({config.file}).write(config.import.output);
  require_dag_name(config.import.output, false);
  AtomicFile::check(config.import.output, config.no_clobber);
  const File file = File::open_read(config.file);
  InputWatch inputs;
  inputs.add(file);
  ImportConfig import = config.import;
  import.source = config.file;
  import.inputs = &inputs;
  const FormatRow& row = choose(config, file);
  std::optional<File> colours;
  if (row.graph == read_hashdag && !config.no_colours) {
    const std::string path = hashdag_colours_path(config.file);
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error))
      inputs.add(colours.emplace(File::open_read(path)));
  }
  reject_options_of_other_formats(config, row);
  const ImportReport report = inputs.guard(
      [&] { return import_as(row, file, colours ? &*colours : nullptr, config, import); });
  if (config.json)
    std::fputs(report_json(report, config.import.output).c_str(), stdout);
  else if (!config.quiet)
    std::printf("%s: %s, %s voxels of %s^3%s, %s DAG nodes, %s\n  content hash %s\n",
                printable(config.import.output).c_str(), row.name,
                format_count(report.voxels).c_str(),
                format_resolution(uint64_t(report.grid.resolution())).c_str(),
                (layers_text(report) + (report.has_colours ? ", colours" : "")).c_str(),
                format_count(report.nodes).c_str(), format_bytes(report.file_bytes).c_str(),
                report.content_hash.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
