#include "builder/import/import.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>

#include "builder/colours/spilled_colours.h"
#include "builder/import/full_cubes.h"
#include "builder/merge/merge.h"
#include "builder/octree/morton.h"
#include "builder/reduce/brick_reduction.h"
#include "builder/run/bake_output.h"
#include "builder/workspace/disk_need.h"
#include "builder/workspace/workspace.h"
#include "io/dag/colours/colour_writer.h"
#include "io/dag/graph/reduce.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/sort/external_sort.h"

namespace svdag {
namespace {

// A voxel is sorted by its Morton code: the brick's code, then the bit in the brick (low 6 bits).
struct CodeWord {
  uint32_t operator()(uint64_t code, size_t i) const { return uint32_t(code >> (i == 0 ? 32 : 0)); }
};
using VoxelSort = ExternalSort<uint64_t, CodeWord>;

// Reduces sorted voxels, as bricks, and the full cubes between them. A voxel is set if it comes
// `min_points` times: equal codes follow one another.
class VoxelReduction {
 public:
  VoxelReduction(int levels, uint64_t min_points, const FullCubes& cubes, SubDagBuilder* builder)
      : levels_(levels), min_points_(min_points), cubes_(cubes), bricks_(builder) {}

  void run(VoxelSort* sort) {
    sort->finish([this](const auto& codes) {
      for (const uint64_t voxel : codes) add(voxel);
    });
    add_cubes(UINT64_MAX);
    add_brick();
    bricks_.finish();
  }

 private:
  void add(uint64_t voxel) {
    repeats_ = voxel == last_ ? repeats_ + 1 : 1;
    last_ = voxel;
    if (repeats_ < min_points_) return;
    add_cubes(voxel);
    if (voxel < covered_) return;
    if (voxel >> 6 != code_) {
      add_brick();
      code_ = voxel >> 6;
    }
    brick_ |= Brick(1) << (voxel & 63);
  }

  void add_brick() {
    if (brick_ != 0) bricks_.add(code_, brick_);
    brick_ = 0;
  }

  // Adds the full cubes that begin at or before voxel `last`.
  void add_cubes(uint64_t last) {
    for (; next_ < cubes_.size() && cubes_[next_].begin <= last; ++next_) {
      const FullCubes::Range cube = cubes_[next_];
      add_brick();
      bricks_.add_full(cube.begin >> 3 * cube.log2_side, levels_ - cube.log2_side);
      covered_ = cube.end();
    }
  }

  const int levels_;
  const uint64_t min_points_;
  const FullCubes& cubes_;
  BrickReduction bricks_;
  uint64_t last_ = UINT64_MAX;  // voxel, and how often it came
  uint64_t repeats_ = 0;
  size_t next_ = 0;       // index in cubes_
  uint64_t covered_ = 0;  // end of the last full cube
  uint64_t code_ = 0;     // of the brick being collected
  Brick brick_ = 0;
};

// A voxel with a layer, a colour, or both, sorted by its brick, then its layer.
struct LabelledVoxel {
  uint64_t brick;  // Morton code
  uint32_t label_and_bit;
  Colour colour;
  uint8_t unused;

  uint32_t label() const { return label_and_bit >> 6; }
  Brick bit() const { return Brick(1) << (label_and_bit & 63); }
};
static_assert(sizeof(LabelledVoxel) == 16);

struct LabelledWord {
  uint32_t operator()(const LabelledVoxel& voxel, size_t i) const {
    return i == 2 ? voxel.label_and_bit : uint32_t(voxel.brick >> (i == 0 ? 32 : 0));
  }
};
using LabelledSort = ExternalSort<LabelledVoxel, LabelledWord>;

// The colours of the voxels of a brick: means of those that came.
class BrickColours {
 public:
  void add(uint32_t bit, const Colour& colour) {
    Sum& sum = sums_[bit];
    ++sum.count;
    const std::array<uint8_t, 3> codes{colour.r, colour.g, colour.b};
    for (size_t c = 0; c < 3; ++c) sum.linear[c] += light16_of_code(codes[c]);
  }
  // Passes the colours of the voxels `of` on, as those of the cubes of `level`, and forgets all.
  void move_to(SpilledColours* spilled, int level, uint64_t brick, Brick of) {
    for (uint32_t bit = 0; bit < 64; ++bit) {
      Sum& sum = sums_[bit];
      if ((of >> bit & 1) == 0) sum = {};
      if (sum.count == 0) continue;
      CubeColour colour{brick << 6 | bit, uint8_t(level), true, true, {}};
      for (size_t c = 0; c < 3; ++c)
        colour.linear[c] = uint16_t((2 * sum.linear[c] + sum.count) / (2 * sum.count));
      spilled->add({&colour, 1});
      sum = {};
    }
  }

 private:
  struct Sum {
    uint64_t count = 0;
    std::array<uint64_t, 3> linear{};
  };
  std::array<Sum, 64> sums_;
};

// Reduces sorted voxels of layers; without `has_layers`, only their union. A voxel is set if it
// comes `min_points` times, in all layers together, so that layers do not change the union.
// `colours`: takes those of the voxels of `level`; null: they have none.
class LabelledReduction {
 public:
  LabelledReduction(bool has_layers, int level, uint64_t min_points, SpilledColours* colours,
                    SubDagBuilder* builder)
      : has_layers_(has_layers),
        level_(level),
        min_points_(min_points),
        colours_(colours),
        bricks_(builder, has_layers) {}

  void run(LabelledSort* sort) {
    sort->finish([this](const auto& voxels) {
      for (const LabelledVoxel& voxel : voxels) add(voxel);
    });
    add_brick();
    bricks_.finish();
  }

 private:
  // In the order of the sort.
  void add(const LabelledVoxel& voxel) {
    if (voxel.brick != code_) {
      add_brick();
      code_ = voxel.brick;
    }
    const Subject layer = subject_of(voxel.label());
    if (sets_.empty() || sets_.back().subject != layer) sets_.push_back({layer, 0});
    sets_.back().brick |= voxel.bit();
    if (min_points_ > 1) ++counts_[voxel.label_and_bit & 63];
    if (colours_ != nullptr) of_brick_.add(voxel.label_and_bit & 63, voxel.colour);
  }

  void add_brick() {
    if (sets_.empty()) return;
    if (min_points_ > 1) keep_frequent();
    Brick all = 0;
    for (const SubjectBrick& set : sets_) all |= set.brick;
    if (colours_ != nullptr) of_brick_.move_to(colours_, level_, code_, all);
    if (sets_.empty()) return;
    sets_.push_back({kUnionSet, all});
    has_layers_ ? bricks_.add(code_, sets_) : bricks_.add(code_, all);
    sets_.clear();
  }

  // Removes the voxels of the brick that came less than min_points_ times.
  void keep_frequent() {
    Brick kept = 0;
    for (uint32_t bit = 0; bit < 64; ++bit) kept |= Brick(counts_[bit] >= min_points_) << bit;
    counts_ = {};
    for (SubjectBrick& set : sets_) set.brick &= kept;
    std::erase_if(sets_, [](const SubjectBrick& set) { return set.brick == 0; });
  }

  const bool has_layers_;
  const int level_;
  const uint64_t min_points_;
  SpilledColours* const colours_;
  BrickReduction bricks_;
  BrickColours of_brick_;
  uint64_t code_ = 0;                  // of the brick being collected
  std::array<uint64_t, 64> counts_{};  // of points in its voxels; unused if one is enough
  std::vector<SubjectBrick> sets_;     // of each layer in it
};

// The colours of the voxels of a DAG, which come in Morton order.
class GraphColours {
 public:
  GraphColours(const DagView& dag, const VoxelColourSource& colours)
      : dag_(dag), colours_(colours) {
    if (!dag.empty()) stack_.emplace_back();
  }

  std::span<const CubeColour> next() {
    constexpr size_t kAtOnce = 4096;
    part_.clear();
    while (part_.size() < kAtOnce && !stack_.empty()) {
      const CoveredCube cube = stack_.back();
      stack_.pop_back();
      if (cube.level == dag_.levels) {
        const Colour colour = colours_.next();
        part_.push_back(
            {cube.morton,
             uint8_t(cube.level),
             true,
             true,
             {light16_of_code(colour.r), light16_of_code(colour.g), light16_of_code(colour.b)}});
        continue;
      }
      const size_t first = stack_.size();
      for_covered_children(dag_, cube, [&](const CoveredCube& child) { stack_.push_back(child); });
      std::reverse(stack_.begin() + std::ptrdiff_t(first), stack_.end());
    }
    return part_;
  }

 private:
  const DagView& dag_;
  const VoxelColourSource& colours_;
  std::vector<CoveredCube> stack_;
  std::vector<CubeColour> part_;
};

class Import {
 public:
  Import(const ImportConfig& config, Executor* executor)
      : config_(config),
        executor_(executor),
        workspace_(ScratchDir::path_for(config.output, config.scratch), config.memory,
                   executor->workers()) {
    workspace_.clear(config.output, kUnfinishedHint);
  }

  ImportReport run(NodeGraph* graph, const VoxelColourSource* colours) {
    const WorkRoom room = workspace_.room();
    DagWriter writer(nodes_path(colours != nullptr), checked_grid(*graph), config_.rule,
                     config_.layout == Layout::kCompact ? std::optional(room) : std::nullopt);
    LayerTable no_layers;
    const ReducedGraph reduced = reduce(graph, room, executor_, &writer, &no_layers);
    files_ += reduced.spilled;
    check_inputs();
    writer.finish(reduced.voxels, config_.largest_snap);
    if (colours == nullptr) return describe(writer.header());
    if (reduced.voxels != colours->count)
      fail_input(colours->path, "has " + format_count(colours->count) +
                                    " colours, but the DAG has " + format_count(reduced.voxels) +
                                    " voxels (--no-colours ignores it)");
    const DagFile nodes = finished_nodes();
    GraphColours of_voxels(nodes.view(), *colours);
    return add_colours(nodes, [&] { return of_voxels.next(); });
  }

  ImportReport run(const VoxelSource& source, uint64_t count, const LayerTable* layers) {
    std::optional<VoxelSort> sort;
    std::optional<LabelledSort> labelled;  // instead of it, from the first voxel on
    sort.emplace(sort_room(), 2, CodeWord());
    DiskNeed(workspace_.scratch())
        .expect_records(count * sizeof(uint64_t), sort_room().bytes / 2, "voxels");
    FullCubes cubes(workspace_.budget());
    bool has_colours = false;
    uint32_t highest = 0;  // bitwise or of all coordinates
    const GridPlacement place = source(
        [&](std::span<const Voxel> voxels, std::span<const uint16_t> labels,
            std::span<const Colour> colours) {
          check_interrupt();
          if (!(labels.empty() && colours.empty()) && !labelled) {
            has_colours = !colours.empty();
            sort.reset();
            labelled.emplace(sort_room(), 3, LabelledWord());
          }
          for (size_t i = 0; i < voxels.size(); ++i) {
            const auto& [x, y, z] = voxels[i];
            highest |= x | y | z;
            const uint64_t code = morton(LatticePoint(x, y, z));
            if (labelled)
              labelled->push({code >> 6,
                              uint32_t(labels.empty() ? 0 : labels[i]) << 6 | uint32_t(code & 63),
                              has_colours ? colours[i] : Colour(), 0});
            else
              sort->push(code);
          }
        },
        [&](const FullCube& cube) {
          const auto& [x, y, z] = cube.origin;
          highest |= x | y | z | ((uint32_t(1) << cube.log2_side) - 1);
          cubes.add(cube);
        });
    cubes.sort();
    const Grid grid = choose_grid(place, highest);
    LayerTable table = layers != nullptr ? *layers : LayerTable();
    SpilledColours colours(workspace_.scratch());
    RunSet set = runs_of(grid.levels, [&](SubDagBuilder* builder) {
      if (labelled)
        LabelledReduction(!table.empty(), grid.levels, config_.min_points,
                          has_colours ? &colours : nullptr, builder)
            .run(&*labelled);
      else
        VoxelReduction(grid.levels, config_.min_points, cubes, builder).run(&*sort);
    });
    sort.reset();  // the merge needs the memory
    labelled.reset();
    if (!has_colours) return finish_runs(std::move(set), grid, std::move(table), config_.output);
    finish_runs(std::move(set), grid, std::move(table), nodes_path(true));
    colours.cut();
    return add_colours(finished_nodes(), [&] { return colours.next(); });
  }

 private:
  // Where the nodes are written: colours come to a copy.
  std::string nodes_path(bool has_colours) {
    return has_colours ? workspace_.folder()->path_of(kBakedName) : config_.output;
  }
  DagFile finished_nodes() { return DagFile::open(nodes_path(true)); }
  ImportReport add_colours(const DagFile& nodes, const CubeColourSource& source) {
    check_inputs();
    return describe(write_coloured(nodes, {uint32_t(nodes.grid().levels), 0}, source,
                                   config_.output, workspace_.room(), executor_));
  }

  Grid checked_grid(const NodeGraph& graph) const {
    const Grid grid = graph.grid();
    if (config_.levels != 0 && config_.levels != grid.levels)
      fail_usage("-r: the file has a fixed resolution of " +
                 format_resolution(uint64_t(grid.resolution())) + ": omit -r");
    return grid;
  }

  // `table`: without roots and voxels.
  ImportReport finish_runs(RunSet set, const Grid& grid, LayerTable table,
                           const std::string& path) {
    Scratch* const scratch = workspace_.scratch();
    DagOutput output(path, grid, config_.rule, config_.layout, workspace_.room());
    for (size_t i = 0; i < set.layer_voxels.size(); ++i)
      table.layers[i].voxels = set.layer_voxels[i];
    const MergeConfig merging =
        share_for_merge(workspace_.budget(), set.spilled ? scratch : nullptr, executor_->workers(),
                        4 * scratch->block_bytes());
    const auto roots = merge(set.runs, std::move(set.roots), GridPart::whole(grid.levels), merging,
                             &output, executor_);
    check_inputs();
    output.finish(roots, set.voxels, config_.largest_snap, std::move(table));
    return describe(output.header());
  }

  File new_file() { return workspace_.folder()->create("sort" + std::to_string(files_++)); }

  // The runs of what `fill` adds.
  RunSet runs_of(int levels, const std::function<void(SubDagBuilder*)>& fill) {
    RunSet set;
    std::unique_ptr<SubDagBuilder> builder;
    const auto take_run = [&](bool spill) {
      const SpillTarget target = new_target(workspace_.scratch(), levels);
      set.add(builder->take_run(spill ? &target : nullptr));
    };
    builder = std::make_unique<SubDagBuilder>(
        levels, SubDagBuilderConfig{.budget = workspace_.budget(),
                                    .table_bytes = workspace_.shares().brick_table,
                                    .empty_table = [&] { take_run(true); }});
    fill(builder.get());
    take_run(set.spilled);
    return set;
  }

  ExternalSortConfig sort_room() {
    const uint64_t min = 2 * executor_->workers() * ExternalSortConfig::kMinBytesPerWorker;
    return {workspace_.budget(), std::max(workspace_.shares().sort, min), executor_,
            [this] { return new_file(); }};
  }

  Grid choose_grid(const GridPlacement& place, uint32_t highest) const {
    if (place.grid) {
      SVDAG_ASSERT(place.grid->is_valid() && uint64_t(highest) >> place.grid->levels == 0);
      return *place.grid;
    }
    const uint64_t needed = std::max<uint64_t>(uint64_t(highest) + 1, place.resolution);
    Grid grid;
    grid.levels = config_.levels != 0 ? config_.levels
                                      : std::max(kMinLevels, int(std::bit_width(needed - 1)));
    if (grid.levels > kMaxLevels || uint64_t(highest) >> grid.levels != 0)
      fail_usage("-r: the voxels need a resolution of at least " +
                 format_count(uint64_t(highest) + 1));
    grid.origin = place.corner;
    grid.voxel_size = place.voxel_size;
    bool valid = std::isnormal(grid.voxel_size) && grid.voxel_size > 0;
    for (int a = 0; a < 3; ++a) valid = valid && std::isfinite(grid.origin[a]);
    if (!valid) fail_input(config_.source, "invalid origin or voxel size of the grid");
    grid.selection = grid.whole();
    return grid;
  }

  void check_inputs() const {
    if (config_.inputs != nullptr) config_.inputs->check();
  }

  ImportReport describe(const Header& header) const {
    ImportReport report = report_of(header);
    report.spilled = files_;
    return report;
  }

  const ImportConfig& config_;
  Executor* executor_;
  Workspace workspace_;
  int files_ = 0;
};

}  // namespace

ImportReport report_of(const Header& header) {
  ImportReport report;
  report.grid = grid_of(header);
  report.layers = header.layer_count;
  report.has_colours = has_colours(header);
  report.voxels = header.voxels;
  for (const Section& section : header.sections) report.nodes += section.nodes;
  report.file_bytes = header.file_bytes;
  report.content_hash = to_hex(header.content_hash);
  return report;
}

ImportReport import_graph(NodeGraph* graph, const VoxelColourSource* colours,
                          const ImportConfig& config, Executor* executor) {
  return Import(config, executor).run(graph, colours);
}

ImportReport import_voxels(const VoxelSource& source, const ImportConfig& config,
                           Executor* executor, uint64_t count, const LayerTable* layers) {
  return Import(config, executor).run(source, count, layers);
}

}  // namespace svdag
