#include "verify/sample/compare.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "verify/sample/judged_cube.h"
#include "verify/sample/solid.h"

namespace svdag {
namespace {

struct CubeTriangle {
  uint64_t cube;  // code
  uint32_t triangle;
  bool operator<(const CubeTriangle& other) const {
    return cube != other.cube ? cube < other.cube : triangle < other.triangle;
  }
};

struct CubeNode {
  uint64_t cube;  // code
  uint32_t node;
};

// The node and the triangles of one cube; begin .. end are its entries in the sorted list.
struct CubeWork {
  uint64_t cube;
  uint32_t node;  // or kNoChild
  size_t begin, end;
};

// Number of triangles or cubes per task of the executor.
constexpr size_t kTriangleChunk = 4096;
constexpr size_t kCubeChunk = 64;

size_t chunks(size_t count, size_t chunk) {
  return (count + chunk - 1) / chunk;
}

using Judges = std::vector<std::unique_ptr<Judge>>;  // one per worker

std::vector<CubeTriangle> triangles_by_cube(const Grid& grid, std::span<const LatticeTriangle> all,
                                            const Judges& judges, Executor& executor,
                                            Progress& progress) {
  const int levels = judged_cube_levels(grid.levels);
  const int shift = grid.fraction() + levels;
  VoxelBox window;
  for (int a = 0; a < 3; ++a) {
    window.min[a] = grid.selection.min[a] >> levels;
    window.max[a] = ((grid.selection.max[a] - 1) >> levels) + 1;
  }
  if (grid.selection.empty()) window = {};
  std::vector<std::vector<CubeTriangle>> lists(executor.workers());
  executor.for_each(chunks(all.size(), kTriangleChunk), [&](size_t worker, size_t chunk) {
    const size_t end = std::min(all.size(), (chunk + 1) * kTriangleChunk);
    for (size_t i = chunk * kTriangleChunk; i < end; ++i) {
      judges[worker]->cells(all[i], shift, window, [&](const CellRun& run) {
        LatticePoint cube = run.first;
        for (int64_t n = 0; n < run.count; ++n, ++cube[run.axis])
          lists[worker].push_back({cell_code(cube), uint32_t(i)});
      });
    }
    progress.advance(end - chunk * kTriangleChunk);
  });
  // Workers get tasks in any order; sorting by (cube, triangle) makes the list deterministic.
  executor.for_each(lists.size(),
                    [&](size_t, size_t i) { std::sort(lists[i].begin(), lists[i].end()); });
  std::vector<CubeTriangle> merged;
  for (std::vector<CubeTriangle>& list : lists) {
    const auto middle = merged.insert(merged.end(), list.begin(), list.end());
    std::vector<CubeTriangle>().swap(list);
    std::inplace_merge(merged.begin(), middle, merged.end());
  }
  return merged;
}

void collect_nodes(const DagView& dag, uint32_t cube_level, uint32_t level, uint32_t node,
                   uint64_t code, std::vector<CubeNode>* out) {
  if (level == cube_level) return out->push_back({code, node});
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    if (child != kNoChild) collect_nodes(dag, cube_level, level + 1, child, code << 3 | c, out);
  }
}

// Merges the three sorted lists: one entry per cube that occurs in any.
std::vector<CubeWork> merge_cube_lists(std::span<const CubeTriangle> triangles,
                                       std::span<const CubeNode> nodes,
                                       std::span<const uint64_t> inside) {
  std::vector<CubeWork> work;
  size_t t = 0, n = 0, i = 0;
  while (t < triangles.size() || n < nodes.size() || i < inside.size()) {
    const uint64_t from_triangle = t < triangles.size() ? triangles[t].cube : UINT64_MAX;
    const uint64_t from_node = n < nodes.size() ? nodes[n].cube : UINT64_MAX;
    const uint64_t from_inside = i < inside.size() ? inside[i] : UINT64_MAX;
    CubeWork cube{std::min({from_triangle, from_node, from_inside}), kNoChild, t, t};
    while (t < triangles.size() && triangles[t].cube == cube.cube) ++t;
    cube.end = t;
    if (from_node == cube.cube) cube.node = nodes[n++].node;
    if (from_inside == cube.cube) ++i;
    work.push_back(cube);
  }
  return work;
}

// Compares cubes, one at a time; one per worker.
class CubeComparison {
 public:
  CubeComparison(const DagView& dag, const Grid& grid, std::span<const LatticeTriangle> triangles,
                 std::span<const CubeTriangle> lists, const SolidColumns& solid, Judge& judge)
      : dag_(dag),
        grid_(grid),
        triangles_(triangles),
        lists_(lists),
        solid_(solid),
        judge_(judge) {}

  void compare(const CubeWork& work, Comparison* result) {
    const int levels = judged_cube_levels(grid_.levels);
    const LatticePoint corner = cell_of_code(work.cube) << int64_t(levels);
    own_->clear();
    file_->clear();
    voxelize(work, corner, int64_t(1) << levels);
    solid_.fill(corner, int64_t(1) << levels, own_.get());
    if (work.node != kNoChild)
      fill_cube(dag_, dag_.levels - uint32_t(levels), work.node, 0, file_.get());
    for (uint64_t code = 0; code < uint64_t(1) << (3 * (levels - 2)); ++code) {
      const Brick own = own_->brick(code), file = file_->brick(code);
      if ((own | file) != 0) result->add_brick(own, file, corner + cell_of_code(code) * int64_t(4));
    }
  }

 private:
  void voxelize(const CubeWork& work, const LatticePoint& corner, int64_t side) {
    VoxelBox window;
    for (int a = 0; a < 3; ++a) {
      window.min[a] = std::max(corner[a], grid_.selection.min[a]);
      window.max[a] = std::min(corner[a] + side, grid_.selection.max[a]);
    }
    const Clipper::Sink sink = [&](const CellRun& run) {
      own_->set({run.first - corner, run.axis, run.count});
    };
    for (size_t i = work.begin; i < work.end; ++i)
      judge_.voxels(triangles_[lists_[i].triangle], grid_.fraction(), window, sink);
  }

  const DagView& dag_;
  const Grid& grid_;
  std::span<const LatticeTriangle> triangles_;
  std::span<const CubeTriangle> lists_;
  const SolidColumns& solid_;
  Judge& judge_;
  std::unique_ptr<JudgedCube> own_ = std::make_unique<JudgedCube>();
  std::unique_ptr<JudgedCube> file_ = std::make_unique<JudgedCube>();
};

}  // namespace

void WrongVoxels::add(const LatticePoint& voxel, bool is_missing) {
  ++(is_missing ? missing : extra);
  if (first.size() < kShown) first.push_back({voxel, is_missing});
}

void WrongVoxels::append(const WrongVoxels& later) {
  missing += later.missing;
  extra += later.extra;
  for (const WrongVoxel& wrong : later.first) {
    if (first.size() < kShown) first.push_back(wrong);
  }
}

void Comparison::add_brick(uint64_t judge, uint64_t file, const LatticePoint& corner) {
  ++bricks;
  judge_voxels += uint64_t(std::popcount(judge));
  file_voxels += uint64_t(std::popcount(file));
  wrong_bricks += judge != file;
  for (uint64_t wrong = judge ^ file; wrong != 0; wrong &= wrong - 1) {
    const unsigned bit = unsigned(std::countr_zero(wrong));
    // Two octal digits, outer and inner child number, are a Morton code of two levels.
    add(corner + cell_of_code(bit), (judge >> bit & 1U) != 0);
  }
}

void Comparison::append(const Comparison& later) {
  WrongVoxels::append(later);
  bricks += later.bricks;
  wrong_bricks += later.wrong_bricks;
  judge_voxels += later.judge_voxels;
  file_voxels += later.file_voxels;
}

Comparison compare_all(const DagView& dag, const Grid& grid,
                       std::span<const LatticeTriangle> triangles, const JudgeChoice& choice,
                       Executor& executor, Progress& progress) {
  const Judges judges = make_judges(choice, executor.workers());
  progress.phase("sorting triangles into cubes", triangles.size());
  const std::vector<CubeTriangle> lists =
      triangles_by_cube(grid, triangles, judges, executor, progress);
  std::vector<CubeNode> nodes;
  const uint32_t cube_level = uint32_t(grid.levels - judged_cube_levels(grid.levels));
  if (!dag.empty()) collect_nodes(dag, cube_level, 0, 0, 0, &nodes);
  const SolidColumns solid(grid, choice.rule, triangles, *judges[0]);
  const std::vector<CubeWork> work = merge_cube_lists(lists, nodes, solid.cubes());

  progress.phase("comparing", work.size());
  std::vector<CubeComparison> comparisons;
  for (size_t i = 0; i < executor.workers(); ++i)
    comparisons.emplace_back(dag, grid, triangles, lists, solid, *judges[i]);
  std::vector<Comparison> parts(chunks(work.size(), kCubeChunk));
  executor.for_each(parts.size(), [&](size_t worker, size_t chunk) {
    const size_t end = std::min(work.size(), (chunk + 1) * kCubeChunk);
    for (size_t i = chunk * kCubeChunk; i < end; ++i)
      comparisons[worker].compare(work[i], &parts[chunk]);
    progress.advance(end - chunk * kCubeChunk);
  });
  progress.finish();
  Comparison all;
  for (const Comparison& part : parts) all.append(part);
  return all;
}

}  // namespace svdag
