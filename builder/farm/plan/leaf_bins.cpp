#include "builder/farm/plan/leaf_bins.h"

#include <algorithm>

#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kBatch = 4096;     // triangles read at once
constexpr uint64_t kMaxCopies = 3;  // mean copies of a triangle that dividing a bin may make

class LeafBinner {
 public:
  LeafBinner(const Grid& grid, const LeafConfig& config, Scratch* scratch, SpillFile* out)
      : grid_(grid), config_(config), scratch_(scratch), out_(out) {}

  void run(SplitScene* scene) {
    if (!scene->tree) {
      for (const TriangleBin& bin : scene->bins) divide_or_copy(scratch_->triangles(), bin);
      return;
    }
    TriangleBins bins = bins_below(Cube(), scene->tree->triangles());
    scene->tree->for_each_triangle(
        [&](const LatticeTriangle& t) { bins.add(t, cut_record_of(t, scene->tree->cuts())); });
    scene->tree.reset();
    divide_all(bins.finish());
  }

  std::vector<TriangleBin> take_leaves() { return std::move(leaves_); }

 private:
  // Only as deep as needed for light bins, if a surface has triangles in 4^depth of the cubes.
  TriangleBins bins_below(const Cube& cube, uint64_t triangles) const {
    const int max_depth =
        std::min(TriangleBins::depth_for(config_.open_bytes, *scratch_, grid_, cube),
                 std::max(1, config_.max_level - cube.level));
    int depth = 1;
    while (depth < max_depth && config_.light << (2 * depth) < triangles) ++depth;
    return TriangleBins(grid_, cube, depth, scratch_->transient(), scratch_);
  }

  void divide_all(const std::vector<TriangleBin>& bins) {
    for (const TriangleBin& bin : bins) {
      divide_or_copy(scratch_->transient(), bin);
      scratch_->transient()->free(bin.stream);
    }
  }

  void divide_or_copy(SpillFile* from, const TriangleBin& bin) {
    const Cube made_for = cube_of(bin.range, grid_.levels);  // bin.cube may be smaller
    if (bin.triangles <= config_.light || made_for.level >= config_.max_level)
      return copy(from, bin);
    std::vector<TriangleBin> parts;
    {
      TriangleBins bins = bins_below(made_for, bin.triangles);
      read(from, bin,
           [&](const LatticeTriangle& triangle, const CutRecord* cut) { bins.add(triangle, cut); });
      parts = bins.finish();
    }
    uint64_t copies = 0;
    for (const TriangleBin& part : parts) copies += part.triangles;
    if (copies <= kMaxCopies * bin.triangles) return divide_all(parts);
    for (const TriangleBin& part : parts) scratch_->transient()->free(part.stream);
    copy(from, bin);
  }

  void copy(SpillFile* from, const TriangleBin& bin) {
    SpillReader reader(from, bin.stream, scratch_->budget());
    SpillWriter writer(out_, leaves_.size() + 1, scratch_->budget());
    for (auto block = reader.next(); !block.empty(); block = reader.next()) writer.append(block);
    leaves_.push_back({bin.cube, bin.range, bin.triangles, writer.finish()});
    check_interrupt();
  }

  template <class Visit>
  void read(SpillFile* from, const TriangleBin& bin, const Visit& visit) {
    BinReader reader(from, bin, scratch_->budget(), SIZE_MAX);
    std::vector<LatticeTriangle> triangles;
    CutRecords cuts;
    for (; reader.read(kBatch, &triangles, &cuts); triangles.clear(), cuts.clear()) {
      check_interrupt();
      for (const LatticeTriangle& triangle : triangles)
        visit(triangle, cut_record_of(triangle, cuts));
    }
  }

  const Grid& grid_;
  const LeafConfig& config_;
  Scratch* scratch_;
  SpillFile* out_;
  std::vector<TriangleBin> leaves_;
};

}  // namespace

std::vector<TriangleBin> make_leaf_bins(SplitScene* scene, const Grid& grid,
                                        const LeafConfig& config, Scratch* scratch,
                                        SpillFile* out) {
  LeafBinner binner(grid, config, scratch, out);
  binner.run(scene);
  return binner.take_leaves();
}

std::vector<TriangleBin> bins_of(const std::vector<TriangleBin>& bins, const CellRange& cells,
                                 int levels) {
  const int shift = 3 * (levels - cells.level);
  const uint64_t begin = cells.begin << shift, end = cells.end << shift;
  std::vector<TriangleBin> overlapping;
  for (const TriangleBin& bin : bins) {
    if (bin.range.begin < end && bin.range.end > begin) overlapping.push_back(bin);
  }
  return overlapping;
}

}  // namespace svdag
