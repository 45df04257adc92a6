#include "verify/sample/sample.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>

#include "verify/judge/judge_cells.h"
#include "verify/sample/solid.h"

namespace svdag {
namespace {

// Triangles per batch, and per task of a worker.
constexpr size_t kBatchTriangles = size_t(1) << 16;
constexpr size_t kTaskTriangles = 1024;

}  // namespace

BrickSample::BrickSample(const Grid& grid, std::vector<uint64_t> codes)
    : grid_(grid), codes_(std::move(codes)), bricks_(codes_.size()) {}

void BrickSample::add(const LatticeTriangle& triangle, Judge& judge) {
  const VoxelBox bricks{LatticePoint(0), LatticePoint(grid_.resolution() / kBrickSide)};
  const VoxelBox box = touched_cells(box_of(triangle), grid_.fraction() + 2, bricks);
  if (box.empty()) return;
  // The smallest octree cell that contains the box: the common prefix of its corners' codes.
  const uint64_t low = cell_code(box.min), high = cell_code(box.max - int64_t(1));
  const int height = int(std::bit_width(low ^ high) + 2) / 3;
  const auto begin = std::lower_bound(codes_.begin(), codes_.end(), low);
  const auto end = std::upper_bound(begin, codes_.end(), high);
  descend(triangle, judge, low >> (3 * height), height, size_t(begin - codes_.begin()),
          size_t(end - codes_.begin()));
}

// begin .. end are the sampled bricks inside `cell`, which is 2^height bricks wide, that the
// triangle may touch.
void BrickSample::descend(const LatticeTriangle& triangle, Judge& judge, uint64_t cell, int height,
                          size_t begin, size_t end) {
  if (begin == end) return;
  if (end - begin <= 2) {
    for (size_t i = begin; i < end; ++i) fill(triangle, judge, i);
    return;
  }
  if (!judge.touches(triangle, grid_.fraction() + 2 + height, cell_of_code(cell))) return;
  for (uint64_t child = cell << 3; child < (cell + 1) << 3; ++child) {
    const auto first = codes_.begin() + ptrdiff_t(begin);
    const uint64_t beyond = (child + 1) << (3 * (height - 1));
    const size_t middle =
        size_t(std::lower_bound(first, codes_.begin() + ptrdiff_t(end), beyond) - codes_.begin());
    descend(triangle, judge, child, height - 1, begin, middle);
    begin = middle;
  }
}

void BrickSample::fill(const LatticeTriangle& triangle, Judge& judge, size_t index) {
  const LatticePoint corner = cell_of_code(codes_[index]) * int64_t(kBrickSide);
  VoxelBox window;
  for (int a = 0; a < 3; ++a) {
    window.min[a] = std::max(corner[a], grid_.selection.min[a]);
    window.max[a] = std::min(corner[a] + kBrickSide, grid_.selection.max[a]);
  }
  Brick brick = 0;
  judge.voxels(triangle, grid_.fraction(), window, [&](const CellRun& run) {
    LatticePoint p = run.first - corner;
    for (int64_t i = 0; i < run.count; ++i, ++p[run.axis])
      brick |= Brick(1) << brick_bit(unsigned(p.x), unsigned(p.y), unsigned(p.z));
  });
  if (brick != 0) std::atomic_ref(bricks_[index]).fetch_or(brick, std::memory_order_relaxed);
}

Brick BrickSample::in_file(const DagView& dag, size_t index) const {
  const LatticePoint brick = cell_of_code(codes_[index]);
  return dag_brick(dag, uint32_t(brick.x), uint32_t(brick.y), uint32_t(brick.z));
}

Comparison BrickSample::compare(const DagView& dag) const {
  Comparison result;
  for (size_t i = 0; i < codes_.size(); ++i)
    result.add_brick(bricks_[i], in_file(dag, i), cell_of_code(codes_[i]) * int64_t(kBrickSide));
  return result;
}

uint64_t BrickSample::count_wrong(const DagView& dag, const std::vector<uint64_t>& draws) const {
  uint64_t wrong = 0;
  for (const uint64_t code : draws) {
    const auto at = std::lower_bound(codes_.begin(), codes_.end(), code);
    const size_t index = size_t(at - codes_.begin());
    wrong += bricks_[index] != in_file(dag, index);
  }
  return wrong;
}

SampleComparison compare_sample(const Scene& scene, const DagView& dag, const Grid& grid,
                                uint64_t count, uint64_t seed, const JudgeChoice& choice,
                                Executor& executor, Progress& progress) {
  CutScene cuts;
  JudgeChoice chosen = choice;
  chosen.cuts = &cuts;
  const std::vector<std::unique_ptr<Judge>> judges = make_judges(chosen, executor.workers());
  progress.phase("drawing bricks", 0);
  const BrickDraw draw = draw_bricks(scene, dag, grid, choice.rule, count, seed);
  std::vector<uint64_t> codes = draw.all();
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());

  BrickSample sample(grid, std::move(codes));
  std::optional<SolidBricks> solid;
  if (is_solid(choice.rule)) solid.emplace(grid, sample.codes());
  std::vector<LatticeTriangle> gathered;
  const auto flush = [&] {
    executor.for_each((gathered.size() + kTaskTriangles - 1) / kTaskTriangles,
                      [&](size_t worker, size_t task) {
                        const size_t end = std::min(gathered.size(), (task + 1) * kTaskTriangles);
                        for (size_t i = task * kTaskTriangles; i < end; ++i) {
                          sample.add(gathered[i], *judges[worker]);
                          if (solid) solid->add(gathered[i], *judges[worker]);
                        }
                      });
    progress.advance(gathered.size());
    gathered.clear();
    cuts.records.clear();
  };
  progress.phase("judging triangles", 0);
  stream_snapped(
      scene, grid, &cuts,
      [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
        gathered.insert(gathered.end(), batch.begin(), batch.end());
        if (gathered.size() >= kBatchTriangles) flush();
      },
      choice.rule, choice.layer);
  flush();
  progress.finish();
  for (size_t i = 0; solid && i < sample.codes().size(); ++i)
    sample.set(i, solid->inside(choice.rule, i));
  SampleComparison result;
  result.comparison = sample.compare(dag);
  result.file = {draw.file.size(), sample.count_wrong(dag, draw.file)};
  for (size_t m = 0; m < kMeasures; ++m) {
    const std::vector<uint64_t>& drawn = draw.scene.codes[m];
    result.scene[m] = {drawn.size(), sample.count_wrong(dag, drawn)};
  }
  result.anywhere = {draw.anywhere.size(), sample.count_wrong(dag, draw.anywhere)};
  result.both_empty = draw.both_empty();
  result.untested = draw.untested();
  return result;
}

}  // namespace svdag
