#include "builder/colours/colour_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

#include "builder/colours/covered_node.h"
#include "builder/colours/cube_sum.h"
#include "builder/colours/painted_bins.h"
#include "builder/colours/painted_scene.h"
#include "builder/colours/part_walker.h"
#include "builder/colours/untouched_nodes.h"
#include "builder/octree/morton.h"
#include "builder/overlap/kernels/divide_list.h"
#include "io/dag/walk/occupied_bounds.h"
#include "io/lattice.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/lap_timer.h"

namespace svdag {
namespace {

constexpr int kPartLog2 = 5;            // of the side of a part, in cubes of level K
constexpr size_t kPartsPerWorker = 16;  // walked before their colours are passed on

class ColourPass {
 public:
  ColourPass(const DagFile& file, const PaintedScene& scene, int level, uint64_t max_triangles,
             Workspace* workspace, Executor* executor, Progress* progress,
             const CubeColourSink& sink, uint64_t begin, const ColoursPassed& passed)
      : dag_(file.view()),
        grid_(file.grid()),
        scene_(scene),
        level_(level),
        part_level_(std::max(0, level - kPartLog2)),
        max_triangles_(max_triangles),
        workspace_(*workspace),
        executor_(*executor),
        progress_(*progress),
        sink_(sink),
        begin_(begin),
        passed_(passed),
        untouched_(dag_, grid_, file.rule(), level, workspace->budget()),
        upper_lists_(size_t(level) + 1) {
    SVDAG_ASSERT(is_between_parts(begin));
    for (size_t i = 0; i < executor->workers(); ++i)
      walkers_.emplace_back(dag_, grid_, file.rule(), level, &untouched_);
  }

  void run(std::vector<PaintedTriangle> triangles, std::vector<PaintedBin> bins) {
    if (dag_.empty()) return;
    const CoveredNode root{Cube(), 0};
    progress_.phase("colour", 4096);
    if (bins.empty()) {
      walk(root, triangles);
    } else {
      visit_bins(root, bins.front().cube.level, &bins);
    }
    flush();
  }

  void report(ColourPassReport* report) const {
    report->entries = entries_;
    for (const PartWalker& walker : walkers_) {
      report->pairs += walker.counts().pairs;
      report->cubes_by_points += walker.counts().cubes_by_points;
    }
  }
  uint64_t missing() const { return untouched_.missing(); }

 private:
  // No part, so no cube of the colour level, begins before and ends after the code.
  bool is_between_parts(uint64_t code) const {
    return code % (uint64_t(1) << 3 * (grid_.levels - part_level_)) == 0;
  }
  bool is_done(const CoveredNode& node) const {
    return morton_range(node.cube, grid_.levels).end <= begin_;
  }
  // Then it has undone children.
  bool is_partly_done(const CoveredNode& node) const {
    const MortonRange range = morton_range(node.cube, grid_.levels);
    return range.begin < begin_ && begin_ < range.end;
  }

  // Visits the covered cubes of `bin_level` in `node` in Morton order, each with its bin. Bins are
  // freed after use.
  void visit_bins(const CoveredNode& node, int bin_level, std::vector<PaintedBin>* bins) {
    size_t next = 0;
    visit_bins(node, bin_level, bins, &next);
  }
  void visit_bins(const CoveredNode& node, int bin_level, std::vector<PaintedBin>* bins,
                  size_t* next) {
    if (is_done(node)) return;
    if (node.cube.level == bin_level) {
      const uint64_t code = morton(node.cube.coordinate);
      for (; *next < bins->size() && morton((*bins)[*next].cube.coordinate) < code; ++*next)
        free((*bins)[*next]);  // nothing is set there, or it is done
      if (*next == bins->size() || (*bins)[*next].cube != node.cube) return untouched(node);
      return visit_bin(node, (*bins)[(*next)++]);
    }
    for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
      visit_bins(covered_child(dag_, node, unsigned(std::countr_zero(mask))), bin_level, bins,
                 next);
  }

  void visit_bin(const CoveredNode& node, const PaintedBin& bin) {
    SpillFile* const file = workspace_.scratch()->transient();
    if (bin.triangles <= max_triangles_) {
      std::vector<PaintedTriangle> triangles(size_t(bin.triangles));
      const auto memory = workspace_.budget()->reserve(bin.triangles * PreparedTriangles::kBytes,
                                                       "triangles with colours");
      PaintedReader reader(file, bin, workspace_.budget());
      for (PaintedTriangle& t : triangles) reader.read(&t);
      free(bin);
      return walk(node, triangles);
    }
    if (node.cube.level == level_) return sum_bin(node, bin);
    const int depth =
        PaintedBins::depth_for(workspace_.shares().open_bins, std::min(level_ - node.cube.level, 2),
                               *workspace_.scratch());
    PaintedBins parts(grid_.levels, node.cube, depth, workspace_.scratch());
    {
      PaintedReader reader(file, bin, workspace_.budget());
      for (PaintedTriangle t; reader.read(&t);) parts.add(t);
    }
    free(bin);
    std::vector<PaintedBin> bins = parts.finish();
    visit_bins(node, node.cube.level + depth, &bins);
  }

  // A cube of the colour level with more triangles than fit in memory.
  void sum_bin(const CoveredNode& node, const PaintedBin& bin) {
    flush();
    const auto memory = workspace_.budget()->reserve(max_triangles_ * PreparedTriangles::kBytes,
                                                     "triangles with colours");
    CubeSum sum;
    {
      PaintedReader reader(workspace_.scratch()->transient(), bin, workspace_.budget());
      std::vector<PaintedTriangle> triangles;
      const auto add = [&] {
        const PreparedTriangles prepared(triangles, scene_.paints,
                                         node.cube.side_log2(grid_.levels), &executor_);
        walkers_[0].add(prepared, node.cube, prepared.all(), true, &sum);
        triangles.clear();
      };
      for (PaintedTriangle t; reader.read(&t);) {
        triangles.push_back(t);
        if (triangles.size() == max_triangles_) add();
      }
      add();
    }
    free(bin);
    walkers_[0].end_cube(node, sum, &parts_.emplace_back(Part{node, {}, {}}).colours);
    flush();
  }

  void free(const PaintedBin& bin) { workspace_.scratch()->transient()->free(bin.stream); }

  void untouched(const CoveredNode& node) {
    if (is_done(node)) return;
    if (is_partly_done(node)) {
      for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
        untouched(covered_child(dag_, node, unsigned(std::countr_zero(mask))));
      return;
    }
    untouched_.add(node, &parts_.emplace_back(Part{node, {}, {}}).colours);
  }

  // Walks a node with all of its triangles.
  void walk(const CoveredNode& node, const std::vector<PaintedTriangle>& triangles) {
    flush();
    const int side_log2 = Cube{level_, {}}.side_log2(grid_.levels);
    const PreparedTriangles prepared(triangles, scene_.paints, side_log2, &executor_);
    prepared_ = &prepared;
    divide(node, prepared.all());
    flush();
    prepared_ = nullptr;
  }

  // Divides down to the parts.
  void divide(const CoveredNode& node, const TriangleList& list) {
    if (is_done(node)) return;
    const bool is_partly = is_partly_done(node);
    if (is_partly && list.empty()) return untouched(node);
    Part part{node, {}, {}};
    if (!is_partly && walkers_[0].ends(*prepared_, node, list, &part.colours)) {
      parts_.push_back(std::move(part));
      return;
    }
    if (node.cube.level >= part_level_) {
      part.list = list;
      listed_ += list.size();
      parts_.push_back(std::move(part));
      if (parts_.size() >= kPartsPerWorker * walkers_.size() ||
          listed_ > prepared_->setups.size() + 4096)
        flush();
      return;
    }
    std::array<TriangleList, 8>& children = upper_lists_[size_t(node.cube.level)];
    divide_list(list, node.cube, grid_.levels, {}, &children);
    for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1) {
      const unsigned c = unsigned(std::countr_zero(mask));
      divide(covered_child(dag_, node, c), children[c]);
    }
  }

  // Walks the parts that wait, and passes their colours on.
  void flush() {
    check_interrupt();
    executor_.for_each(parts_.size(), [&](size_t worker, size_t i) {
      if (!parts_[i].list.empty()) walkers_[worker].walk(*prepared_, &parts_[i]);
    });
    for (const Part& part : parts_) {
      entries_ += part.colours.size();
      if (!part.colours.empty()) sink_(part.colours);
    }
    if (!parts_.empty()) pass_to(morton_range(parts_.back().node.cube, grid_.levels).end);
    parts_.clear();
    listed_ = 0;
  }

  // Cubes without a triangle are an error at the end, with their number: none is left behind.
  void pass_to(uint64_t end) {
    if (passed_ && is_between_parts(end) && missing() == 0) passed_(end);
    const uint64_t done = uint64_t(double(end) / std::ldexp(1.0, 3 * grid_.levels) * 4096);
    if (done > shown_) progress_.advance(done - shown_);
    shown_ = std::max(done, shown_);
  }

  const DagView& dag_;
  const Grid grid_;
  const PaintedScene& scene_;
  int level_, part_level_;
  uint64_t max_triangles_;
  Workspace& workspace_;
  Executor& executor_;
  Progress& progress_;
  const CubeColourSink& sink_;
  uint64_t begin_;
  const ColoursPassed& passed_;
  UntouchedNodes untouched_;
  std::vector<PartWalker> walkers_;                       // [worker]
  std::vector<std::array<TriangleList, 8>> upper_lists_;  // [level]: of the children there
  std::vector<Part> parts_;
  uint64_t listed_ = 0;  // triangles in the lists of parts_
  const PreparedTriangles* prepared_ = nullptr;
  uint64_t entries_ = 0, shown_ = 0;
};

[[noreturn]] void fail_foreign(const DagFile& file, const std::string& what) {
  fail_input(file.path(), "does not belong to this scene: " + what);
}

// The scene must reach as far as the voxels do, unless they are those of a solid that ends at the
// selection.
void check_bounds(const DagFile& file, const PaintedScene& scene) {
  if (file.rule() == Rule::kPoints)
    fail_input(file.path(), "has rule points, not of triangles: svdag import stores the colours");
  if (file.view().empty() || (is_solid(file.rule()) && file.grid().bounded)) return;
  if (scene.is_empty) fail_foreign(file, "no triangle of the scene meets its grid");
  const Lattice lattice(file.grid());
  const VoxelBox occupied = occupied_bounds(file.view());
  for (int a = 0; a < 3; ++a) {
    if (occupied.min[a] < lattice.first_voxel(scene.box.min[a]) ||
        occupied.max[a] - 1 > lattice.last_voxel(scene.box.max[a]))
      fail_foreign(file, std::string("on axis ") + "xyz"[a] + " its voxels reach from " +
                             std::to_string(occupied.min[a]) + " to " +
                             std::to_string(occupied.max[a] - 1) + ", the scene from " +
                             std::to_string(lattice.first_voxel(scene.box.min[a])) + " to " +
                             std::to_string(lattice.last_voxel(scene.box.max[a])));
  }
}

}  // namespace

void check_colour_level(const ColourPassConfig& config, int levels) {
  if (!config.level || (*config.level >= kMinColourLevel && *config.level <= levels)) return;
  fail_usage("--colour-level " + std::to_string(*config.level) + ": choose " +
             std::to_string(kMinColourLevel) + " to " + std::to_string(levels));
}

ColourPassReport colour_cubes(const DagFile& file, const Scene& scene,
                              const ColourPassConfig& config, Workspace* workspace,
                              Executor* executor, Progress* progress, const CubeColourSink& sink,
                              uint64_t begin, const ColoursPassed& passed) {
  const Grid grid = file.grid();
  ColourPassReport report;
  LapTimer timer;
  const uint64_t max_triangles =
      std::max<uint64_t>(workspace->shares().triangles / PreparedTriangles::kBytes, 1024);
  const int bin_depth = PaintedBins::depth_for(
      workspace->shares().open_bins, config.level.value_or(kMinColourLevel), *workspace->scratch());
  PaintedScene painted;
  SceneReader reader(grid, max_triangles, PreparedTriangles::kBytes, bin_depth, workspace,
                     &painted);
  progress->phase("read", 0, "triangles");
  painted.counts = scene.stream([&](const TriangleBatch& batch) {
    reader.read(batch);
    progress->advance(batch.triangles.size(), batch.triangles.size());
  });
  report.split_seconds = timer.lap();
  report.scene = painted.counts;
  check_bounds(file, painted);
  report.level = config.level.value_or(level_for(painted.density, grid.levels));
  if (painted.density.area != 0)
    report.texels_per_cube = double(painted.density.texels) / double(painted.density.area) *
                             double(int64_t(1) << (grid.levels - report.level));
  std::vector<PaintedBin> bins;
  if (painted.bins) bins = painted.bins->finish();
  ColourPass pass(file, painted, report.level, max_triangles, workspace, executor, progress, sink,
                  begin, passed);
  pass.run(std::move(painted.triangles), std::move(bins));
  pass.report(&report);
  if (pass.missing() > 0)
    fail_foreign(file, format_count(pass.missing()) +
                           " of its cubes have no triangle: give the scene, options and pose that "
                           "it was built with");
  report.walk_seconds = timer.lap();
  return report;
}

}  // namespace svdag
