#include "builder/bake/bake_bins.h"

#include <algorithm>
#include <optional>
#include <set>

#include "builder/descend/dense_cube.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kBatch = 4096;       // triangles read at once
constexpr int kCellsBelow = 2;        // levels from a bin's cube to its cells: work to share out
constexpr int kSmallestCellLog2 = 6;  // of the side of such a cell in voxels

}  // namespace

BinBaker::BinBaker(const Grid& grid, const SplitConfig& split, const DescentConfig& descent,
                   const MortonSet* done, Voxelizer* voxelizer, MemoryBudget* budget,
                   Executor* executor, Progress* progress)
    : grid_(grid),
      split_(split),
      descent_(descent),
      done_(done),
      voxelizer_(voxelizer),
      budget_(budget),
      executor_(executor),
      progress_(progress) {}

void BinBaker::bake(SpillFile* file, const TriangleBin& bin) {
  if (done_ != nullptr && done_->coverage(bin.range) == MortonSet::Coverage::kAll) return;
  const MortonRange own = morton_range(bin.cube, grid_.levels);
  const MortonSet::Coverage done =
      done_ != nullptr ? done_->coverage(own) : MortonSet::Coverage::kNone;
  if (done == MortonSet::Coverage::kAll) return voxelizer_->note_empty(bin.range);
  if (const auto tree = load(file, bin)) return voxelizer_->bake(*tree, bin.range, progress_);
  // A dense cube is baked whole: one of which a part is done, or is not wanted, is divided.
  if (done == MortonSet::Coverage::kNone &&
      grid_.levels - bin.cube.level <= DenseCube::kMaxSideLog2)
    return bake_dense(file, bin);
  bake_parts(file, bin);
}

template <class Visit>
bool BinBaker::read(SpillFile* file, const TriangleBin& bin, size_t batch, const Visit& visit) {
  BinReader reader(file, bin, budget_);
  std::vector<LatticeTriangle> triangles;
  triangles.reserve(std::min<uint64_t>(batch, bin.triangles));
  for (; reader.read(batch, &triangles); triangles.clear()) {
    check_interrupt();
    if (!visit(&triangles)) return false;
  }
  return true;
}

// The bin as a tree; null if that is too much.
std::unique_ptr<CellTree> BinBaker::load(SpillFile* file, const TriangleBin& bin) {
  if (bin.triangles * sizeof(LatticeTriangle) > split_.triangle_bytes) return nullptr;
  const int finest = std::max(grid_.levels - kSmallestCellLog2, bin.cube.level);
  const int cell_level = std::max(split_.cell_level, bin.cube.level + kCellsBelow);
  auto tree = std::make_unique<CellTree>(grid_, bin.cube,
                                         std::min({cell_level, finest, grid_.levels - 2}), budget_);
  const bool fits = read(file, bin, kBatch, [&](const std::vector<LatticeTriangle>* triangles) {
    for (const LatticeTriangle& triangle : *triangles) tree->add(triangle);
    return tree->bytes(split_.workers) <= split_.triangle_bytes;
  });
  if (!fits) return nullptr;
  tree->seal();
  return tree;
}

void BinBaker::bake_dense(SpillFile* file, const TriangleBin& bin) {
  constexpr uint64_t kPerTriangle =
      sizeof(LatticeTriangle) + sizeof(TriangleSetup) + 8 * sizeof(ListedTriangle);
  const uint64_t most = std::max(split_.triangle_bytes / kPerTriangle, uint64_t(kBatch));
  const auto reservation = budget_->reserve(most * kPerTriangle, "triangles of a dense cube");
  DenseCube cube(grid_, bin.cube, budget_);
  progress_->phase("voxelize a dense cube", bin.triangles);
  std::set<Subject> subjects;
  // Fills the bitmap with all triangles, or those of a layer.
  const auto fill = [&](std::optional<Subject> only) {
    cube.clear();
    read(file, bin, most, [&](std::vector<LatticeTriangle>* triangles) {
      if (only) {
        std::erase_if(*triangles, [&](const LatticeTriangle& t) { return t.subject != *only; });
      } else {
        for (const LatticeTriangle& t : *triangles) subjects.insert(t.subject);
        progress_->advance(triangles->size());
      }
      cube.add(*triangles, descent_, executor_);
      return true;
    });
  };
  fill({});
  voxelizer_->bake(bin.cube, bin.range, [&](NodeTable* table, std::vector<SubjectDag>* dags) {
    if (subjects.size() == 1) return dags->push_back({*subjects.begin(), cube.reduce(table)});
    dags->push_back({kUnionSet, cube.reduce(table)});
    for (const Subject subject : subjects) {
      fill(subject);
      dags->push_back({subject | kApart, cube.reduce(table)});
    }
  });
}

void BinBaker::bake_parts(SpillFile* file, const TriangleBin& bin) {
  // A surface in 4^depth parts of as many: deep enough that most fit.
  const uint64_t fitting = split_.triangle_bytes / (2 * sizeof(LatticeTriangle));
  const int most =
      TriangleBins::depth_for(split_.triangle_bytes / 2, *split_.scratch, grid_, bin.cube);
  int depth = 1;
  while (depth < most && (fitting << (2 * depth)) < bin.triangles) ++depth;
  SpillFile* transient = split_.scratch->transient();
  TriangleBins bins(grid_, bin.cube, depth, transient, split_.scratch);
  read(file, bin, kBatch, [&](const std::vector<LatticeTriangle>* triangles) {
    for (const LatticeTriangle& triangle : *triangles) bins.add(triangle);
    return true;
  });
  uint64_t at = bin.range.begin;
  for_each_bin(bins.finish(), progress_, [&](const TriangleBin& part) {
    voxelizer_->note_empty({at, part.range.begin});
    bake(transient, part);
    transient->free(part.stream);
    at = part.range.end;
  });
  voxelizer_->note_empty({at, bin.range.end});
}

}  // namespace svdag
