#include "builder/bake/bake_bins.h"

#include <algorithm>
#include <optional>
#include <set>

#include "builder/descend/dense_cube.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kBatch = 4096;  // triangles read at once
constexpr int kCellsBelow = 2;   // levels from a bin's cube to its cells: work to share out
// Each worker prepares the triangles of a heavy cell again: with cells of level 5, a dense scan
// with 256 MiB took 1.08 times the CPU time.
constexpr int kMinCellLevel = 6;
constexpr int kSmallestCellLog2 = 6;  // of the side of such a cell in voxels

}  // namespace

BinBaker::BinBaker(const Grid& grid, const SplitConfig& split, const MortonSet* done,
                   Voxelizer* voxelizer, MemoryBudget* budget, Executor* executor,
                   Progress* progress)
    : grid_(grid),
      split_(split),
      done_(done),
      voxelizer_(voxelizer),
      budget_(budget),
      executor_(executor),
      progress_(progress) {}

void BinBaker::bake(SpillFile* file, const TriangleBin& all, const CellWindings* windings) {
  if (done_ != nullptr && done_->coverage(all.range) == MortonSet::Coverage::kAll)
    return progress_->skip();
  TriangleBin bin = all;
  // Winding numbers are known where the bin begins, not where its voxels do.
  if (windings != nullptr) bin.cube = cube_of(bin.range, grid_.levels);
  const MortonRange own = morton_range(bin.cube, grid_.levels);
  const MortonSet::Coverage done =
      done_ != nullptr ? done_->coverage(own) : MortonSet::Coverage::kNone;
  if (done == MortonSet::Coverage::kAll) return voxelizer_->bake_untouched(bin.range, windings);
  if (bake_tree(file, bin, windings)) return;
  // A dense cube is baked whole. A cube that is partly done or outside the part is divided.
  if (done == MortonSet::Coverage::kNone &&
      grid_.levels - bin.cube.level <= DenseCube::max_side_log2(split_.content.rule))
    return bake_dense(file, bin, windings);
  bake_parts(file, bin, windings);
}

std::unique_ptr<CellWindings> BinBaker::finer_windings(const CellWindings* known, const Cube& cube,
                                                       int level) {
  if (known == nullptr || level <= known->level()) return nullptr;
  return std::make_unique<CellWindings>(grid_.levels, cube, level, budget_);
}

size_t BinBaker::materials() const {
  const CutOuts* const cut_outs = voxelizer_->descent().cut_outs;
  return cut_outs == nullptr ? 0 : cut_outs->size();
}

template <class Visit>
bool BinBaker::read(SpillFile* file, const TriangleBin& bin, size_t batch, const Visit& visit) {
  BinReader reader(file, bin, budget_, materials());
  std::vector<LatticeTriangle> triangles;
  CutRecords cuts;
  triangles.reserve(std::min<uint64_t>(batch, bin.triangles));
  for (; reader.read(batch, &triangles, &cuts); triangles.clear(), cuts.clear()) {
    check_interrupt();
    if (!visit(&triangles, cuts)) return false;
  }
  return true;
}

// Bakes the bin as a tree; false if that is too much.
bool BinBaker::bake_tree(SpillFile* file, const TriangleBin& bin, const CellWindings* windings) {
  if (bin.triangles * PackedTriangles::kMinBytes > split_.triangle_bytes) return false;
  const int finest = std::max(grid_.levels - kSmallestCellLog2, bin.cube.level);
  const int wanted = std::max({split_.cell_level, bin.cube.level + kCellsBelow, kMinCellLevel});
  const int cell_level = std::min({wanted, finest, grid_.levels - 2});
  CellTree tree(grid_, bin.cube, cell_level, budget_);
  const auto own = finer_windings(windings, bin.cube, cell_level);
  const bool fits = read(file, bin, kBatch, [&](const auto* triangles, const CutRecords& cuts) {
    for (const LatticeTriangle& triangle : *triangles) {
      tree.add(triangle, cut_record_of(triangle, cuts));
      if (own) own->add(triangle);
    }
    return tree.bytes(split_.workers) <= split_.triangle_bytes;
  });
  if (!fits) return false;
  tree.seal();
  if (own) own->finish(windings->at(bin.cube));
  voxelizer_->bake(&tree, own ? own.get() : windings, bin.range, progress_);
  return true;
}

void BinBaker::bake_dense(SpillFile* file, const TriangleBin& bin, const CellWindings* windings) {
  const uint64_t per_triangle = sizeof(LatticeTriangle) + sizeof(TriangleSetup) +
                                8 * sizeof(ListedTriangle) +
                                (materials() > 0 ? sizeof(CutRecord) : 0);
  const uint64_t most = std::max(split_.triangle_bytes / per_triangle, uint64_t(kBatch));
  const auto reservation = budget_->reserve(most * per_triangle, "triangles of a dense cube");
  DenseCube cube(grid_, bin.cube, voxelizer_->descent(), budget_);
  progress_->phase("voxelize a dense cube", bin.triangles);
  const LayerWindings at_cube = windings != nullptr ? windings->at(bin.cube) : LayerWindings();
  std::set<Subject> subjects;
  for (const LayerWinding& w : at_cube) {
    if (w.subject != kUnionSet) subjects.insert(w.subject);
  }
  bool same = true;  // the union and the only layer, if there is one
  // Fills the bitmap with all triangles, or with the triangles of a layer.
  const auto fill = [&](std::optional<Subject> only) {
    cube.clear(only ? kSheetOfLayer : kSheetOfUnion);
    read(file, bin, most, [&](std::vector<LatticeTriangle>* triangles, const CutRecords& cuts) {
      if (only) {
        std::erase_if(*triangles, [&](const LatticeTriangle& t) { return t.subject != *only; });
      } else {
        for (const LatticeTriangle& t : *triangles) {
          subjects.insert(t.subject);
          same &= t.subject == kUnionSet || is_sheet_of_both_or_none(t.sheet);
        }
        progress_->advance(triangles->size());
      }
      cube.add(*triangles, cuts, executor_);
      return true;
    });
    cube.fill(winding_of(at_cube, only.value_or(kUnionSet)));
  };
  fill({});
  same &= subjects.size() == 1 &&
          winding_of(at_cube, *subjects.begin()) == winding_of(at_cube, kUnionSet);
  voxelizer_->bake(
      bin.cube, windings, bin.range, [&](NodeTable* table, std::vector<SetsDag>* dags) {
        if (same)
          return dags->push_back({SubDagSets::with_union(*subjects.begin()), cube.reduce(table)});
        dags->push_back({{}, cube.reduce(table)});
        for (const Subject subject : subjects) {
          fill(subject);
          dags->push_back({SubDagSets::only(subject), cube.reduce(table)});
        }
      });
}

void BinBaker::bake_parts(SpillFile* file, const TriangleBin& bin, const CellWindings* windings) {
  // A surface meets about 4^depth parts. They are deep enough that most fit.
  const uint64_t fitting = split_.triangle_bytes / (2 * PackedTriangles::kMinBytes);
  const int most =
      TriangleBins::depth_for(split_.triangle_bytes / 2, *split_.scratch, grid_, bin.cube);
  int depth = 1;
  while (depth < most && (fitting << (2 * depth)) < bin.triangles) ++depth;
  SpillFile* transient = split_.scratch->transient();
  TriangleBins bins(grid_, bin.cube, depth, transient, split_.scratch);
  const auto own = finer_windings(windings, bin.cube, bin.cube.level + depth);
  read(file, bin, kBatch, [&](const auto* triangles, const CutRecords& cuts) {
    for (const LatticeTriangle& triangle : *triangles) {
      bins.add(triangle, cut_record_of(triangle, cuts));
      if (own) own->add(triangle);
    }
    return true;
  });
  if (own) own->finish(windings->at(bin.cube));
  const CellWindings* const of_parts = own ? own.get() : windings;
  uint64_t at = bin.range.begin;
  for_each_bin(bins.finish(), progress_, [&](const TriangleBin& part) {
    voxelizer_->bake_untouched({at, part.range.begin}, of_parts);
    bake(transient, part, of_parts);
    transient->free(part.stream);
    at = part.range.end;
  });
  voxelizer_->bake_untouched({at, bin.range.end}, of_parts);
}

}  // namespace svdag
