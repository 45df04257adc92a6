#include "builder/colours/colour_pass.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "builder/colours/covered_node.h"
#include "builder/colours/cube_share.h"
#include "builder/colours/cube_sum.h"
#include "builder/colours/painted_bins.h"
#include "builder/octree/morton.h"
#include "builder/overlap/exact_voxel.h"
#include "builder/overlap/kernels/divide_list.h"
#include "io/dag/cube_walk.h"
#include "io/dag/occupied_bounds.h"
#include "io/lattice.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"
#include "streaming/process/lap_timer.h"

namespace svdag {
namespace {

constexpr int kPartLog2 = 5;            // of the side of a part, in cubes of level K
constexpr size_t kPartsPerWorker = 16;  // walked before their colours are passed on
constexpr uint64_t kListedBytes = 8 * sizeof(ListedTriangle);

// Whether the closed triangle meets the closed cube.
bool meets_cube(const TriangleSetup& t, const LatticePoint& corner, int side_log2) {
  if (!t.box.meets({corner, corner + (int64_t(1) << side_log2)})) return false;
  if (!voxel_meets_plane(t, corner, side_log2, 0)) return false;
  for (int k = 0; k < 9; ++k) {
    if ((t.edges >> k & 1) && !column_reaches(t, k, corner, side_log2, 0)) return false;
  }
  return true;
}

// Triangles in memory, prepared for the walk.
struct PreparedTriangles {
  static constexpr uint64_t kBytes = sizeof(PaintedTriangle) + sizeof(TriangleSetup) +
                                     sizeof(ShareSetup) + sizeof(uint64_t) + kListedBytes;
  static constexpr uint64_t kVarying = UINT64_MAX;

  std::vector<TriangleSetup> setups;
  std::vector<ShareSetup> shares;
  std::vector<uint64_t> one_colours;  // packed, or kVarying

  PreparedTriangles(const std::vector<PaintedTriangle>& triangles, const Paints& paints,
                    int side_log2, Executor* executor) {
    setups.resize(triangles.size());
    constexpr size_t kAtOnce = 4096;
    executor->for_each((triangles.size() + kAtOnce - 1) / kAtOnce, [&](size_t, size_t part) {
      const size_t end = std::min(triangles.size(), (part + 1) * kAtOnce);
      for (size_t i = part * kAtOnce; i < end; ++i) setups[i] = make_setup(triangles[i].triangle());
    });
    shares.reserve(triangles.size());
    one_colours.reserve(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
      const PaintedTriangle& t = triangles[i];
      shares.emplace_back(t, setups[i], paints, side_log2);
      const auto& colour = t.corners[0].colour;
      one_colours.push_back(t.has_one_colour()
                                ? uint64_t(colour[0]) << 32 | uint64_t(colour[1]) << 16 | colour[2]
                                : kVarying);
    }
  }

  size_t index_of(const ListedTriangle& entry) const {
    return size_t(entry.triangle - setups.data());
  }
  // The packed colour that all triangles of a list have, or kVarying.
  uint64_t one_colour_of(const TriangleList& list) const {
    const uint64_t first = one_colours[index_of(list.front())];
    for (const ListedTriangle& entry : list) {
      if (one_colours[index_of(entry)] != first) return kVarying;
    }
    return first;
  }
  TriangleList all() const {
    TriangleList list;
    list.reserve(setups.size());
    for (const TriangleSetup& setup : setups) list.push_back({&setup, setup.edges});
    return list;
  }
};

// A part of a bin, which one worker walks.
struct Part {
  CoveredNode node;
  TriangleList list;
  std::vector<CubeColour> colours;  // the result
};

struct WalkCounts {
  uint64_t pairs = 0, cubes_by_points = 0;
};

// The covered cubes that no triangle meets.
class UntouchedNodes {
 public:
  UntouchedNodes(const DagView& dag, const Grid& grid, Rule rule, int level)
      : dag_(dag),
        grid_(grid),
        is_solid_(is_solid(rule)),
        level_(level),
        walk_(dag, dag.levels),
        counts_(dag.levels) {}

  // Appends an entry without colour, or counts cubes that should have had one.
  void add(const CoveredNode& node, std::vector<CubeColour>* out) {
    const std::lock_guard lock(mutex_);
    visit(node, out);
  }
  uint64_t missing() const { return missing_; }

 private:
  void visit(const CoveredNode& node, std::vector<CubeColour>* out) {
    const int level = node.cube.level;
    const bool is_cut_off = is_solid_ && grid_.bounded;  // a solid may end at the selection
    if ((is_solid_ && is_full(node)) || (is_cut_off && level == level_))
      return out->push_back({morton(node.cube.coordinate), uint8_t(level), false, false, {}});
    if (!is_cut_off) {
      missing_ += count(node);
      return;
    }
    for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
      visit(covered_child(dag_, node, unsigned(std::countr_zero(mask))), out);
  }

  bool is_full(const CoveredNode& node) {
    const int level = node.cube.level, bricks = int(dag_.brick_level());
    if (level <= bricks) return walk_.is_full(uint32_t(level), uint32_t(node.content));
    return level == grid_.levels || node.content == 0xff;
  }

  // Of covered cubes of the colour level.
  uint64_t count(const CoveredNode& node) {
    if (node.cube.level == level_) return 1;
    const bool is_stored = node.cube.level < int(dag_.brick_level());
    if (is_stored) {
      const auto known = counts_[size_t(node.cube.level)].find(node.content);
      if (known != counts_[size_t(node.cube.level)].end()) return known->second;
    }
    uint64_t sum = 0;
    for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1)
      sum += count(covered_child(dag_, node, unsigned(std::countr_zero(mask))));
    if (is_stored) counts_[size_t(node.cube.level)][node.content] = sum;
    return sum;
  }

  const DagView& dag_;
  const Grid& grid_;
  bool is_solid_;
  int level_;
  std::mutex mutex_;
  CubeWalk walk_;
  std::vector<std::unordered_map<uint64_t, uint64_t>> counts_;  // [level], by index
  uint64_t missing_ = 0;
};

// Walks parts: of one worker, with the memory of its lists.
class PartWalker {
 public:
  PartWalker(const DagView& dag, const Grid& grid, Rule rule, int level, UntouchedNodes* untouched)
      : dag_(dag),
        levels_(grid.levels),
        is_solid_(is_solid(rule)),
        level_(level),
        untouched_(untouched),
        lists_(size_t(level) + 1) {}

  void walk(const PreparedTriangles& triangles, Part* part) {
    triangles_ = &triangles;
    out_ = &part->colours;
    visit(part->node, part->list);
  }
  const WalkCounts& counts() const { return counts_; }

  // Adds the triangles of `list` that meet the cube. `nearest`: their nearest points as well.
  void add(const PreparedTriangles& triangles, const Cube& cube, const TriangleList& list,
           bool nearest, CubeSum* sum) {
    const LatticePoint corner = cube.corner(levels_);
    counts_.pairs += list.size();
    members_.clear();
    for (const ListedTriangle& entry : list) {
      const size_t i = triangles.index_of(entry);
      const CubeShare share = triangles.shares[i].share_in(corner);
      const bool surely = share.area >= kSurelyMeets && !entry.triangle->wide;
      if (!surely && !meets_cube(*entry.triangle, corner, cube.side_log2(levels_))) continue;
      sum->add(share, triangles.one_colours[i] != PreparedTriangles::kVarying);
      members_.push_back(i);
    }
    if (sum->has_area() && !nearest) return;
    for (const size_t i : members_) sum->add_nearest(triangles.shares[i].nearest_to_centre(corner));
  }
  // The entry of a cube of the colour level.
  void end_cube(const CoveredNode& node, const CubeSum& sum, std::vector<CubeColour>* out) {
    if (sum.empty()) return untouched_->add(node, out);
    counts_.cubes_by_points += !sum.has_area();
    out->push_back(sum.colour(morton(node.cube.coordinate), level_));
  }

  // If the triangles of `list` end the walk at `node`, appends its entry.
  bool ends(const PreparedTriangles& triangles, const CoveredNode& node, const TriangleList& list,
            std::vector<CubeColour>* out) {
    if (list.empty()) return untouched_->add(node, out), true;
    if (is_solid_ || node.cube.level == level_) return false;
    const uint64_t colour = triangles.one_colour_of(list);
    if (colour == PreparedTriangles::kVarying) return false;
    out->push_back({morton(node.cube.coordinate),
                    uint8_t(node.cube.level),
                    true,
                    true,
                    {uint16_t(colour >> 32), uint16_t(colour >> 16), uint16_t(colour)}});
    return true;
  }

 private:
  void visit(const CoveredNode& node, const TriangleList& list) {
    if (ends(*triangles_, node, list, out_)) return;
    if (node.cube.level == level_) {
      CubeSum sum;
      add(*triangles_, node.cube, list, false, &sum);
      return end_cube(node, sum, out_);
    }
    std::array<TriangleList, 8>& children = lists_[size_t(node.cube.level)];
    divide_list(list, node.cube, levels_, {}, &children);
    const size_t first = out_->size();
    for (uint32_t mask = covered_children(dag_, node); mask != 0; mask &= mask - 1) {
      const unsigned c = unsigned(std::countr_zero(mask));
      visit(covered_child(dag_, node, c), children[c]);
    }
    join(node, first);
  }

  // Makes one entry of those from `first` on, if all are children of `node` of one constant colour.
  void join(const CoveredNode& node, size_t first) {
    const auto same = [&](const CubeColour& entry) {
      return entry.is_constant && entry.level == node.cube.level + 1 &&
             std::ranges::equal(entry.linear, (*out_)[first].linear);
    };
    if (out_->size() == first || !std::all_of(out_->begin() + long(first), out_->end(), same))
      return;
    (*out_)[first].morton = morton(node.cube.coordinate);
    (*out_)[first].level = uint8_t(node.cube.level);
    out_->resize(first + 1);
  }

  const DagView& dag_;
  int levels_;
  bool is_solid_;
  int level_;
  UntouchedNodes* untouched_;
  std::vector<std::array<TriangleList, 8>> lists_;  // [level]: of the children there
  std::vector<size_t> members_;                     // of the cube being added
  const PreparedTriangles* triangles_ = nullptr;
  std::vector<CubeColour>* out_ = nullptr;
  WalkCounts counts_;
};

// Reads the scene: triangles in memory, or in bins if they exceed `max_triangles`.
struct PaintedScene {
  SceneCounts counts;
  Paints paints;
  std::vector<PaintedTriangle> triangles;
  MemoryBudget::Reservation memory;  // of `triangles`, prepared
  std::optional<PaintedBins> bins;
  LatticeBox box;  // of the triangles that meet the grid
  bool is_empty = true;
  TexelDensity density;
};

bool is_invisible(const CutOut& cut) {
  return cut.image->width() == 1 && cut.image->height() == 1 &&
         double(cut.image->at(0, 0)) < cut.threshold;
}

uint32_t paint_number(const Paint& paint, Paints* all) {
  const auto found = std::ranges::find(*all, paint);
  if (found != all->end()) return uint32_t(found - all->begin());
  all->push_back(paint);
  return uint32_t(all->size() - 1);
}

class SceneReader {
 public:
  SceneReader(const Grid& grid, uint64_t max_triangles, int bin_depth, Workspace* workspace,
              PaintedScene* out)
      : grid_(grid),
        lattice_(grid),
        whole_(grid.closed(grid.whole())),
        max_triangles_(max_triangles),
        bin_depth_(bin_depth),
        workspace_(*workspace),
        out_(*out) {
    out_.memory = workspace_.budget()->reserve(0, kPurpose);
  }

  void read(const TriangleBatch& batch) {
    if (batch.cut != nullptr && is_invisible(*batch.cut)) return;
    const std::array<uint16_t, 3> plain = colour_of(batch);
    const uint32_t paint =
        batch.paint != nullptr ? paint_number(*batch.paint, &out_.paints) : kOneColour;
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      PaintedTriangle t;
      for (size_t i = 0; i < 3; ++i) {
        t.corners[i].position = lattice_.snap(batch.triangles[k].v[i]);
        t.corners[i].colour = plain;
      }
      if (batch.paint != nullptr) paint_corners(batch, k, paint, &t);
      sort_corners(&t);
      out_.density.add(t, grid_.fraction());
      const LatticeBox box = box_of(t.triangle());
      if (!box.meets(whole_)) continue;
      if (out_.is_empty) out_.box = box;
      out_.is_empty = false;
      out_.box.add(box);
      keep(t);
    }
  }

 private:
  static constexpr const char* kPurpose = "triangles with colours";

  static std::array<uint16_t, 3> colour_of(const TriangleBatch& batch) {
    if (!batch.colour) return {kWhite16, kWhite16, kWhite16};
    return {light16_of_code(batch.colour->r), light16_of_code(batch.colour->g),
            light16_of_code(batch.colour->b)};
  }

  static void paint_corners(const TriangleBatch& batch, size_t k, uint32_t paint,
                            PaintedTriangle* t) {
    const CornerColours& colours = batch.corner_colours[k];
    const auto one = one_colour(*batch.paint, colours);
    t->paint = one ? kOneColour : paint;
    for (size_t i = 0; i < 3; ++i) {
      t->corners[i].colour = one ? *one : colours[i];
      if (batch.paint->image) t->corners[i].texture = batch.texture[k][i];
    }
  }

  void keep(const PaintedTriangle& t) {
    if (out_.bins) return out_.bins->add(t);
    if (out_.triangles.size() == max_triangles_) {
      out_.bins.emplace(grid_.levels, Cube(), bin_depth_, workspace_.scratch());
      for (const PaintedTriangle& kept : out_.triangles) out_.bins->add(kept);
      out_.triangles = {};
      out_.memory.release();
      return out_.bins->add(t);
    }
    if (out_.triangles.size() == out_.triangles.capacity()) {
      const size_t room = size_t(
          std::min<uint64_t>(max_triangles_, std::max<size_t>(1024, 2 * out_.triangles.size())));
      out_.memory.resize(room * PreparedTriangles::kBytes, kPurpose);
      out_.triangles.reserve(room);
    }
    out_.triangles.push_back(t);
  }

  const Grid& grid_;
  Lattice lattice_;
  LatticeBox whole_;
  uint64_t max_triangles_;
  int bin_depth_;
  Workspace& workspace_;
  PaintedScene& out_;
};

// K: a cube spans one to two texels.
int level_for(const TexelDensity& density, int levels) {
  if (density.area == 0 || density.texels == 0) return levels;
  double texels = double(density.texels) / double(density.area);
  int level = levels;
  for (; texels < 1 && level > kMinColourLevel; --level) texels *= 2;
  return level;
}

class ColourPass {
 public:
  ColourPass(const DagFile& file, const PaintedScene& scene, int level, uint64_t max_triangles,
             Workspace* workspace, Executor* executor, Progress* progress,
             const CubeColourSink& sink)
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
        untouched_(dag_, grid_, file.rule(), level),
        upper_lists_(size_t(level) + 1) {
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
  // Visits the covered cubes of `bin_level` in `node` in Morton order, each with its bin. Bins are
  // freed after use.
  void visit_bins(const CoveredNode& node, int bin_level, std::vector<PaintedBin>* bins) {
    size_t next = 0;
    visit_bins(node, bin_level, bins, &next);
  }
  void visit_bins(const CoveredNode& node, int bin_level, std::vector<PaintedBin>* bins,
                  size_t* next) {
    if (node.cube.level == bin_level) {
      const uint64_t code = morton(node.cube.coordinate);
      for (; *next < bins->size() && morton((*bins)[*next].cube.coordinate) < code; ++*next)
        free((*bins)[*next]);  // nothing is set there
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
    Part part{node, {}, {}};
    if (walkers_[0].ends(*prepared_, node, list, &part.colours)) {
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
    if (!parts_.empty()) advance(parts_.back().node.cube);
    parts_.clear();
    listed_ = 0;
  }

  void advance(const Cube& last) {
    const MortonRange range = morton_range(last, grid_.levels);
    const uint64_t done = uint64_t(double(range.end) / std::ldexp(1.0, 3 * grid_.levels) * 4096);
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

// The scene must reach as far as the voxels do.
void check_bounds(const DagFile& file, const PaintedScene& scene) {
  if (file.view().empty()) return;
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

ColourPassReport colour_cubes(const DagFile& file, const Scene& scene,
                              const ColourPassConfig& config, Workspace* workspace,
                              Executor* executor, Progress* progress, const CubeColourSink& sink) {
  const Grid grid = file.grid();
  ColourPassReport report;
  LapTimer timer;
  const uint64_t max_triangles =
      std::max<uint64_t>(workspace->shares().triangles / PreparedTriangles::kBytes, 1024);
  const int bin_depth = PaintedBins::depth_for(
      workspace->shares().open_bins, config.level.value_or(kMinColourLevel), *workspace->scratch());
  PaintedScene painted;
  SceneReader reader(grid, max_triangles, bin_depth, workspace, &painted);
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
  ColourPass pass(file, painted, report.level, max_triangles, workspace, executor, progress, sink);
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
