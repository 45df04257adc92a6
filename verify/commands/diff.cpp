#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/dag/open_dag.h"
#include "io/dag/walk/occupied_bounds.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/command_files.h"
#include "streaming/file/file.h"
#include "verify/commands/commands.h"
#include "verify/compare/dag_diff.h"
#include "verify/compare/grid_alignment.h"
#include "verify/trace/difference_picture.h"
#include "verify/trace/presets.h"

namespace svdag {
namespace {

struct DifferingVoxel {
  LatticePoint voxel;
  bool in_a;
};

// "corner (0, 0, 0), side 64": the cube of a grid in the world.
std::string place_of(const Grid& grid) {
  return "corner " + format_point(grid.corner()) + ", side " +
         formatted("%.9g", double(grid.resolution()) * grid.voxel_size);
}

void require_same_place(const DagFile& a, const DagFile& b) {
  if (!same_place(a.grid(), b.grid()))
    fail_usage(a.path() + " and " + b.path() + " have grids in different places, " +
               place_of(a.grid()) + " and " + place_of(b.grid()) +
               ": to compare them by voxel index add --by-index");
}

std::vector<DifferingVoxel> first_differing(DagDiff* diff, uint64_t max) {
  std::vector<DifferingVoxel> voxels;
  if (max == 0) return voxels;
  diff->visit([&](const std::array<uint32_t, 3>& at, uint64_t a, uint64_t b) {
    for (unsigned bit = 0; bit < 64 && voxels.size() < max; ++bit) {
      if (((a ^ b) >> bit & 1) == 0) continue;
      const auto [x, y, z] = brick_voxel(bit);
      voxels.push_back(
          {LatticePoint(4 * at[0] + x, 4 * at[1] + y, 4 * at[2] + z), (a >> bit & 1) != 0});
    }
    return voxels.size() < max;
  });
  return voxels;
}

// The clusters that are listed, with their boxes in the world of A.
struct ListedClusters {
  size_t total = 0;
  std::vector<DiffCluster> first;
  std::vector<Box> boxes;
};

ListedClusters list_clusters(DagDiff* diff, const Grid& a) {
  constexpr size_t kMaxListed = 10;
  const std::vector<DiffCluster> clusters = diff_clusters(diff);
  const Grid grid = level_grid(a, int(diff->levels()));
  ListedClusters listed{clusters.size(), {}, {}};
  for (size_t i = 0; i < std::min(clusters.size(), kMaxListed); ++i) {
    listed.first.push_back(clusters[i]);
    listed.boxes.push_back(world_box(grid, clusters[i].box));
  }
  return listed;
}

// Draws both from the default view.
void render_both(const DiffConfig& config, const DagFile& a, const DagFile& b, Progress* progress) {
  RenderConfig picture;
  picture.width = config.size.width;
  picture.height = config.size.height;
  const DagView &one = a.view(), &two = b.view();
  const VoxelBounds box = framing_bounds(two, framing_bounds(one));
  constexpr int kUp = 1;
  const Camera camera =
      preset_camera("iso", {}, box, kUp, Camera::kDefaultFov, config.size.aspect());
  const Shading shading = make_shading(ShadeMode::kPrimary, one, camera, kUp, box);
  ParallelExecutor executor(threads_or_all(0));
  write_png(render_difference(one, two, camera, shading, picture, executor, *progress),
            config.render);
}

// The outputs are none of the inputs, have the right names, and can be written.
void check_outputs(const DiffConfig& config) {
  CommandFiles files({config.a, config.b});
  for (const std::string& output : {config.write_diff, config.render}) {
    if (output.empty()) continue;
    files.write(output);
    AtomicFile::check(output);
  }
  if (!config.write_diff.empty() && !config.write_diff.ends_with(".ply"))
    fail_usage(config.write_diff + ": the difference is written as a .ply");
  if (config.render.empty()) return;
  reject_other_picture_format(config.render, ".png", "pictures are PNG: choose a name in .png");
}

struct DiffLayer {
  std::string name;
  DiffCounts counts;
};

// The layer `number`; empty without a number.
DagView view_of(const DagFile& file, std::optional<size_t> number) {
  if (number) return file.view_of(*number);
  DagView none = file.view();
  none.brick_count = 0;
  return none;
}

// By name; nothing if one of the files has no layers.
std::vector<DiffLayer> diff_layers(const DagFile& a, const DagFile& b) {
  std::vector<DiffLayer> result;
  if (a.layers().empty() || b.layers().empty()) return result;
  std::map<std::string, std::array<std::optional<size_t>, 2>> numbers;  // in a and in b
  for (const size_t f : {0, 1}) {
    const std::vector<Layer>& layers = (f == 0 ? a : b).layers().layers;
    for (size_t i = 0; i < layers.size(); ++i) numbers[layers[i].name][f] = i;
  }
  for (const auto& [name, number] : numbers) {
    const DagView one = view_of(a, number[0]), two = view_of(b, number[1]);
    result.push_back({name, DagDiff(one, two).count()});
  }
  return result;
}

bool same(const DiffCounts& counts, const std::vector<DiffLayer>& layers) {
  return counts.same() &&
         std::ranges::all_of(layers, [](const DiffLayer& l) { return l.counts.same(); });
}

// By their hashes; nothing if no file has colours. They do not decide the verdict.
const char* compared_colours(const DagFile& a, const DagFile& b) {
  if (!a.has_colours()) return b.has_colours() ? "only B" : nullptr;
  if (!b.has_colours()) return "only A";
  return std::ranges::equal(a.header().colour_hash, b.header().colour_hash) ? "same" : "different";
}

std::string member(const char* list, size_t i) {
  return std::string(list) + "/" + std::to_string(i) + "/";
}

void add_counts(Verdict* verdict, const std::string& key, const DiffCounts& counts) {
  verdict->also(key + "both", counts.both, "in both");
  verdict->also(key + "only_a", counts.only_a, "only A");
  verdict->also(key + "only_b", counts.only_b, "only B");
}

Verdict verdict_of(const DiffConfig& config, const DagDiff& diff, const DiffCounts& counts,
                   const std::vector<DiffLayer>& layers, const ListedClusters& clusters,
                   const std::vector<DifferingVoxel>& voxels, const char* colours) {
  Verdict verdict;
  verdict.for_programs("command", "diff");
  verdict.for_programs("a", config.a);
  verdict.for_programs("b", config.b);
  const uint64_t resolution = uint64_t(1) << diff.levels();
  verdict.add("resolution", "compared",
              shown(resolution, "at " + format_resolution(resolution) + "^3"));
  verdict.also("pairs", counts.pairs, "pairs of nodes");
  verdict.add("both", "both", counts.both, "voxels");
  verdict.add("only_a", "only A", counts.only_a);
  verdict.add("only_b", "only B", counts.only_b);
  for (size_t i = 0; i < layers.size(); ++i) {
    verdict.hide(layers[i].counts.same());
    verdict.add(member("layers", i) + "name", "layer",
                shown(layers[i].name, shown_layer(layers[i].name)));
    add_counts(&verdict, member("layers", i), layers[i].counts);
  }
  verdict.hide(false);
  add_agreeing_layers(
      &verdict, std::ranges::count_if(layers, [](const DiffLayer& l) { return l.counts.same(); }));
  verdict.add("clusters", "clusters", clusters.total);
  verdict.for_programs("largest_clusters", FigureValue::List());
  for (size_t i = 0; i < clusters.first.size(); ++i) {
    const std::string key = member("largest_clusters", i);
    const auto& [min, max] = clusters.boxes[i];
    verdict.add(key + "only_a", "cluster", clusters.first[i].only_a, "voxels only A");
    verdict.also(key + "only_b", clusters.first[i].only_b, "only B");
    verdict.also(key + "bounds", shown(std::array{min.x, min.y, min.z, max.x, max.y, max.z},
                                       "in " + format_point(min) + " to " + format_point(max)));
  }
  verdict.for_programs("first", FigureValue::List());
  for (size_t i = 0; i < voxels.size(); ++i) {
    const auto& [voxel, in_a] = voxels[i];
    verdict.add(member("first", i) + "voxel", in_a ? "only A" : "only B",
                shown(std::array{voxel.x, voxel.y, voxel.z},
                      "voxel (" + std::to_string(voxel.x) + ", " + std::to_string(voxel.y) + ", " +
                          std::to_string(voxel.z) + ")"));
    verdict.for_programs(member("first", i) + "in", in_a ? "a" : "b");
  }
  if (colours != nullptr)
    verdict.add(
        "colours", "colours",
        shown(colours, std::string(colours) == "different" ? "stored differently" : colours));
  verdict.add("same", "", shown(same(counts, layers), same(counts, layers) ? "same" : "different"));
  return verdict;
}

}  // namespace

int run(const DiffConfig& config) {
  const Stopwatch stopwatch(config.common);
  check_outputs(config);
  Progress progress(config.common.progress);
  progress.phase("checksums", 0);
  const DagFile a = open_dag(config.a, config.selection), b = open_dag(config.b, config.selection);
  if (!config.by_index) require_same_place(a, b);
  if (!config.render.empty() && a.view().levels != b.view().levels)
    fail_usage("--render: needs files of equal resolution: coarsen one with svdag edit --level");
  if (!config.render.empty() && a.view().empty() && b.view().empty())
    fail_usage("--render: neither file has a voxel");
  progress.phase("compare", 0);
  DagDiff diff(a.view(), b.view());
  const DiffCounts counts = diff.count();
  if (!config.write_diff.empty())
    write_difference(&diff, counts, a.grid(), config.write_diff, config.write_most);
  if (!config.render.empty()) render_both(config, a, b, &progress);
  const std::vector<DiffLayer> layers = diff_layers(a, b);
  const ListedClusters clusters = list_clusters(&diff, a.grid());
  const auto voxels = first_differing(&diff, counts.same() ? 0 : config.show);
  progress.finish();
  return finish(config.common,
                verdict_of(config, diff, counts, layers, clusters, voxels, compared_colours(a, b)),
                same(counts, layers));
}

}  // namespace svdag
