#include "verify/commands/diff.h"
#include "io/pack/unpack.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/dag/occupied_bounds.h"
#include "io/json_text.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/file.h"
#include "verify/commands/render.h"
#include "verify/compare/diff.h"
#include "verify/compare/diff_clusters.h"
#include "verify/compare/difference_points.h"
#include "verify/compare/grid_alignment.h"
#include "verify/trace/difference_picture.h"
#include "verify/trace/program/picture_name.h"
#include "verify/trace/program/presets.h"

namespace svdag {
namespace {

struct DifferingVoxel {
  LatticePoint voxel;
  bool in_a;
};

// "corner (0, 0, 0), side 64": the cube of a grid in the world.
std::string place_of(const Grid& grid) {
  char side[32];
  std::snprintf(side, sizeof side, "%.9g", double(grid.resolution()) * grid.voxel_size);
  return "corner " + format_point(grid.corner()) + ", side " + side;
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
  const RenderConfig picture = parse_size(config.size);
  const DagView &one = a.view(), &two = b.view();
  VoxelBounds box = framing_bounds(one.empty() ? two : one);
  const VoxelBounds other = framing_bounds(two.empty() ? one : two);
  for (int i = 0; i < 3; ++i) {
    box.min[i] = std::min(box.min[i], other.min[i]);
    box.max[i] = std::max(box.max[i], other.max[i]);
  }
  constexpr int kUp = 1;
  const Camera camera = preset_camera("iso", {}, box, kUp, Camera::kDefaultFov,
                                      double(picture.width) / picture.height);
  const Shading shading = make_shading(ShadeMode::kPrimary, one, camera, kUp, box);
  ParallelExecutor executor(threads_or_all(0));
  write_png(render_difference(one, two, camera, shading, picture, executor, *progress),
            config.render);
}

// The outputs are none of the inputs, have the right names, and can be written.
void check_outputs(const DiffConfig& config) {
  for (const std::string& output : {config.write_diff, config.render}) {
    if (output.empty()) continue;
    for (const std::string& input : {config.a, config.b}) {
      if (same_file(input, output))
        fail_usage(output + ": is an input; choose another name for the difference");
    }
    AtomicFile::check(output);
  }
  if (!config.write_diff.empty() && !config.write_diff.ends_with(".ply"))
    fail_usage(config.write_diff + ": the difference is written as a .ply");
  if (config.render.empty()) return;
  reject_other_picture_format(config.render, ".png", "pictures are PNG: choose a name in .png");
  parse_size(config.size);
}

struct DiffLayer {
  std::string name;
  DiffCounts counts;
};

// The layer `name`; empty if the file has none of that name.
DagView view_of(const DagFile& file, const std::string& name) {
  const std::vector<Layer>& layers = file.layers().layers;
  const auto found = std::ranges::find(layers, name, &Layer::name);
  if (found != layers.end()) return file.view_of(size_t(found - layers.begin()));
  DagView none = file.view();
  none.brick_count = 0;
  return none;
}

// By name; nothing if one of the files has no layers.
std::vector<DiffLayer> diff_layers(const DagFile& a, const DagFile& b) {
  std::vector<DiffLayer> result;
  if (a.layers().empty() || b.layers().empty()) return result;
  std::set<std::string> names;
  for (const DagFile* file : {&a, &b}) {
    for (const Layer& layer : file->layers().layers) names.insert(layer.name);
  }
  for (const std::string& name : names) {
    const DagView one = view_of(a, name), two = view_of(b, name);
    result.push_back({name, DagDiff(one, two).count()});
  }
  return result;
}

bool same(const DiffCounts& counts, const std::vector<DiffLayer>& layers) {
  return counts.same() &&
         std::ranges::all_of(layers, [](const DiffLayer& l) { return l.counts.same(); });
}

void print_json(const DiffConfig& config, const DagDiff& diff, const DiffCounts& counts,
                const std::vector<DiffLayer>& layers, const ListedClusters& clusters,
                const std::vector<DifferingVoxel>& voxels) {
  nlohmann::json json = {{"command", "diff"},       {"a", config.a},
                         {"b", config.b},           {"same", same(counts, layers)},
                         {"both", counts.both},     {"only_a", counts.only_a},
                         {"only_b", counts.only_b}, {"resolution", uint64_t(1) << diff.levels()},
                         {"pairs", counts.pairs}};
  for (const DiffLayer& layer : layers)
    json["layers"].push_back({{"name", layer.name},
                              {"both", layer.counts.both},
                              {"only_a", layer.counts.only_a},
                              {"only_b", layer.counts.only_b}});
  json["clusters"] = clusters.total;
  json["largest_clusters"] = nlohmann::json::array();
  for (size_t i = 0; i < clusters.first.size(); ++i) {
    const auto& [min, max] = clusters.boxes[i];
    json["largest_clusters"].push_back({{"only_a", clusters.first[i].only_a},
                                        {"only_b", clusters.first[i].only_b},
                                        {"bounds", {min.x, min.y, min.z, max.x, max.y, max.z}}});
  }
  json["first"] = nlohmann::json::array();
  for (const DifferingVoxel& o : voxels)
    json["first"].push_back(
        {{"voxel", {o.voxel.x, o.voxel.y, o.voxel.z}}, {"in", o.in_a ? "a" : "b"}});
  std::printf("%s\n", json_text(json).c_str());
}

void print_text(const DagDiff& diff, const DiffCounts& counts, const std::vector<DiffLayer>& layers,
                const ListedClusters& clusters, const std::vector<DifferingVoxel>& voxels) {
  std::printf("compared at %s^3, %s pairs of nodes\n",
              format_resolution(uint64_t(1) << diff.levels()).c_str(),
              format_count(counts.pairs).c_str());
  std::printf("both    %s voxels\nonly A  %s\nonly B  %s\n", format_count(counts.both).c_str(),
              format_count(counts.only_a).c_str(), format_count(counts.only_b).c_str());
  for (const auto& [name, of_layer] : layers)
    std::printf("layer %s: both %s, only A %s, only B %s\n", shown_layer(name).c_str(),
                format_count(of_layer.both).c_str(), format_count(of_layer.only_a).c_str(),
                format_count(of_layer.only_b).c_str());
  for (size_t i = 0; i < clusters.first.size(); ++i)
    std::printf("cluster %zu of %zu  %s voxels only A, %s only B, in %s to %s\n", i + 1,
                clusters.total, format_count(clusters.first[i].only_a).c_str(),
                format_count(clusters.first[i].only_b).c_str(),
                format_point(clusters.boxes[i].min).c_str(),
                format_point(clusters.boxes[i].max).c_str());
  for (const DifferingVoxel& o : voxels)
    std::printf("only %c  voxel (%lld, %lld, %lld)\n", o.in_a ? 'A' : 'B',
                static_cast<long long>(o.voxel.x), static_cast<long long>(o.voxel.y),
                static_cast<long long>(o.voxel.z));
  std::printf(same(counts, layers) ? "same\n" : "different\n");
}

}  // namespace

int run(const DiffConfig& config) {
  const Stopwatch stopwatch(config.common);
  check_outputs(config);
  Progress progress(config.common.progress);
  progress.phase("checksums", 0);
  const DagFile a = open_dag(config.a, config.layers), b = open_dag(config.b, config.layers);
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
  if (config.common.json) {
    print_json(config, diff, counts, layers, clusters, voxels);
  } else if (!config.common.quiet) {
    print_text(diff, counts, layers, clusters, voxels);
  }
  return int(same(counts, layers) ? ExitCode::kOk : ExitCode::kDiffers);
}

}  // namespace svdag
