#include "builder/commands/import/import_command.h"

#include <array>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <optional>

#include "builder/commands/import/points.h"
#include "builder/commands/import/vdb.h"
#include "builder/run/bake_output.h"
#include "io/dag/format.h"
#include "io/dag/symvox_header.h"
#include "io/formats/dags/hashdag.h"
#include "io/formats/dags/hashdag_colours.h"
#include "io/formats/dags/symvox.h"
#include "io/formats/dags/transform_dag.h"
#include "io/formats/points/point_files.h"
#include "io/formats/voxels/binvox.h"
#include "io/formats/voxels/npz.h"
#include "io/formats/voxels/vox.h"
#include "io/help/command_line.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/file/file_ending.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

using GraphReader = std::unique_ptr<NodeGraph> (*)(const File&);
using VoxelReader = GridPlacement (*)(const File&, const VoxelSink&, LayerTable*, bool with_colours,
                                      int up);
using PointReader = std::unique_ptr<PointCloud> (*)(const File&);
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
bool looks_like_las(const File&, FileStart start) {
  return start.starts_with("LASF");
}
bool looks_like_pcd(const File& file, FileStart start) {
  return start.starts_with("# .PCD") || has_ending(file.path(), ".pcd");
}
bool looks_like_ply_points(const File& file, FileStart start) {
  return (start.starts_with("ply\n") || start.starts_with("ply\r")) && has_only_points(file);
}
bool looks_like_xyz(const File& file, FileStart) {
  return has_ending(file.path(), ".xyz");
}

GridPlacement read_binvox_alone(const File& file, const VoxelSink& sink, LayerTable*, bool, int) {
  return read_binvox(file, sink);
}
GridPlacement read_npz_alone(const File& file, const VoxelSink& sink, LayerTable* layers,
                             bool with_colours, int) {
  return read_npz(file, sink, layers, with_colours);
}

struct FormatRow {
  const char* name;
  bool (*matches)(const File&, FileStart);
  GraphReader graph;  // at most one of the three readers is set; for OpenVDB, none
  VoxelReader voxels;
  PointReader points;
};

// The only table of formats; those with a magic number come first.
constexpr FormatRow kFormats[] = {
    {"transform-dag", looks_like_transform_dag, read_transform_dag, nullptr, nullptr},
    {"npz", looks_like_npz, nullptr, read_npz_alone, nullptr},
    {"binvox", looks_like_binvox, nullptr, read_binvox_alone, nullptr},
    {"vox", looks_like_vox, nullptr, read_vox, nullptr},
    {"vdb", looks_like_vdb, nullptr, nullptr, nullptr},
    {"las", looks_like_las, nullptr, nullptr, open_las},
    {"ply", looks_like_ply_points, nullptr, nullptr, open_ply_points},
    {"pcd", looks_like_pcd, nullptr, nullptr, open_pcd},
    {"xyz", looks_like_xyz, nullptr, nullptr, open_xyz},
    {"hashdag", looks_like_hashdag, read_hashdag, nullptr, nullptr},
    {"symvox", looks_like_symvox, read_symvox, nullptr, nullptr},
};

const FormatRow& choose(const ImportCommandConfig& config, const File& file) {
  const std::string& path = file.path();
  std::array<char, 8> bytes{};
  const size_t size = file.read_some_at(0, std::as_writable_bytes(std::span(bytes)));
  const FileStart start(bytes.data(), size);
  if (size == sizeof kMagic && std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0)
    fail_usage(path + ": is already a .svdag of this program");
  std::string names;
  for (const FormatRow& row : kFormats) {
    if (config.format.empty() ? row.matches(file, start) : config.format == row.name) return row;
    names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  if (!config.format.empty())
    fail_usage("--format: unknown format \"" + config.format + "\": choose one of " + names);
  if (has_ending(path, ".ply")) fail_input(path, "is a mesh: bake it with svdag build");
  if (start == "ASTM-E57")
    fail_input(path,
               "is an E57 file, which svdag cannot read: convert it to .las, for example with pdal "
               "translate");
  fail_input(path, "unknown file format: choose one with --format: " + names +
                       " (svdag build bakes scenes)");
}

// Rejects options of other formats, which this one would ignore.
void reject_options_of_other_formats(const ImportCommandConfig& config, const std::string& path,
                                     const FormatRow& row) {
  const auto reject = [&](bool given, const char* option, const char* ending) {
    if (given)
      fail_usage(std::string(option) + ": only for " + ending + " files; " + path + " is read as " +
                 row.name);
  };
  const bool is_vdb = row.graph == nullptr && row.voxels == nullptr && row.points == nullptr;
  reject(!is_vdb && !config.grid.empty(), "--grid", ".vdb");
  reject(!is_vdb && config.iso, "--iso", ".vdb");
  reject(row.voxels != read_vox && config.up, "--up", ".vox");
  const bool is_of_voxels = row.points == nullptr;
  const char* const points = ".las, .ply, .pcd and .xyz";
  reject(is_of_voxels && config.voxel_size, "--voxel-size", points);
  reject(is_of_voxels && config.import.min_points > 1, "--min-points", points);
  reject(is_of_voxels && config.layers != LayerKind::kNone, "--layers", points);
  reject(row.points != open_las && config.layers == LayerKind::kMaterial, "--layers class", ".las");
  if (is_of_voxels && config.files.size() > 1)
    fail_usage(path + ": is read as " + row.name + ": several files must be of points");
}

ImportReport import_points(std::vector<PointInput> inputs, const ImportCommandConfig& config,
                           ImportConfig import) {
  ParallelExecutor executor(threads_or_all(config.threads));
  const PointVoxels voxels(std::move(inputs),
                           {config.voxel_size, import.levels, !config.no_colours, config.layers});
  import.rule = voxels.rule();
  const auto read = [&](const VoxelSink& sink, const FullCubeSink&) { return voxels.read(sink); };
  ImportReport report = import_voxels(read, import, &executor, voxels.count(), &voxels.layers());
  if (import.rule == Rule::kPoints) {
    report.points = voxels.count();
    report.points_left_out = voxels.left_out();
  }
  return report;
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
      return row.voxels(file, sink, config.no_layers ? nullptr : &layers, !config.no_colours,
                        config.up.value_or(kDefaultVoxUp));
    };
    return import_voxels(read, import, &executor, 0, &layers);
  }
  std::unique_ptr<VdbGrid> grid = read_vdb(file.path(), config.grid, config.iso, config.sandbox);
  reject_needless_range(*grid, config.iso);
  const VdbVoxels voxels(std::move(grid), file.path());
  const auto read = [&](const VoxelSink& sink, const FullCubeSink& cubes) {
    return voxels.read(sink, cubes);
  };
  return import_voxels(read, import, &executor, voxels.count());
}

// "5 points (1 more left out), " of points, else nothing.
std::string points_text(const ImportReport& report) {
  if (report.points == 0) return {};
  const uint64_t left_out = report.points_left_out;
  return format_count(report.points, "point") +
         (left_out == 0 ? "" : " (" + format_count(left_out) + " more left out)") + ", ";
}

}  // namespace

std::vector<std::string> import_formats() {
  std::vector<std::string> names;
  for (const FormatRow& row : kFormats) names.emplace_back(row.name);
  return names;
}

int run(const ImportCommandConfig& config) {
  CommandFiles(config.files).write(config.import.output);
  require_dag_name(config.import.output, false);
  AtomicFile::check(config.import.output, config.no_clobber);
  InputWatch inputs;
  std::deque<File> files;
  std::vector<const FormatRow*> rows;
  for (const std::string& path : config.files) {
    const File& file = files.emplace_back(File::open_read(path));
    inputs.add(file);
    rows.push_back(&choose(config, file));
    reject_options_of_other_formats(config, path, *rows.back());
  }
  ImportConfig import = config.import;
  import.source = config.files.front();
  import.inputs = &inputs;
  const FormatRow& row = *rows.front();
  std::optional<File> colours;
  if (row.graph == read_hashdag && !config.no_colours) {
    const std::string path = hashdag_colours_path(import.source);
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error))
      inputs.add(colours.emplace(File::open_read(path)));
  }
  const ImportReport report = inputs.guard([&] {
    if (row.points == nullptr)
      return import_as(row, files.front(), colours ? &*colours : nullptr, config, import);
    std::vector<PointInput> clouds;
    for (size_t i = 0; i < files.size(); ++i)
      clouds.push_back({files[i].path(), rows[i]->points(files[i]), {}});
    return import_points(std::move(clouds), config, import);
  });
  if (config.json)
    std::fputs(report_json(report, config.import.output).c_str(), stdout);
  else if (!config.quiet)
    std::printf("%s: %s, %s%s voxels of %s^3%s, %s DAG nodes, %s\n  content hash %s\n",
                printable(config.import.output).c_str(), row.name, points_text(report).c_str(),
                format_count(report.voxels).c_str(),
                format_resolution(uint64_t(report.grid.resolution())).c_str(),
                (layers_text(report) + (report.has_colours ? ", colours" : "")).c_str(),
                format_count(report.nodes).c_str(), format_bytes(report.file_bytes).c_str(),
                report.content_hash.c_str());
  return int(ExitCode::kOk);
}

}  // namespace svdag
