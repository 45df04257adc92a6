#include "tests/bench/accuracy_methods.h"

#include "builder/descend/descend.h"
#include "builder/descend/voxelize_window.h"
#include "builder/overlap/overlap.h"
#include "tests/bench/peers/akenine_moller.h"
#include "tests/bench/peers/integer.h"
#include "tests/bench/peers/schwarz_seidel.h"
#ifdef SVDAG_HAS_CGAL
#include "tests/bench/peers/cgal.h"
#endif

namespace svdag::bench {
namespace {

// The builder's descent without the reduction: divide_list, then bricks.
class BuilderDescent {
 public:
  explicit BuilderDescent(const Grid& grid) : grid_(grid), lists_(size_t(grid.levels)) {}

  void run(const Cube& cell, const std::vector<LatticeTriangle>& triangles, BrickList* out) {
    std::vector<TriangleSetup> setups;
    setups.reserve(triangles.size());
    TriangleList list;
    const LatticePoint corner = cell.corner(grid_.levels);
    const int64_t side = int64_t(1) << cell.side_log2(grid_.levels);
    for (const LatticeTriangle& t : triangles) {
      setups.push_back(make_setup(t));
      if (setups.back().box.meets({corner, corner + side}))
        list.push_back({&setups.back(), setups.back().edges});
    }
    descend(cell, list, out);
  }

 private:
  void descend(const Cube& cube, const TriangleList& list, BrickList* out) {
    if (list.empty()) return;
    if (cube.level < grid_.levels - 2) {
      auto& lists = lists_[size_t(cube.level)];
      divide_list(list, cube, grid_.levels, {}, &lists);
      for (unsigned c = 0; c < 8; ++c) descend(cube.child(c), lists[c], out);
      return;
    }
    const Brick voxels = kernels().conservative.brick(
        list.data(), list.size(), cube.corner(grid_.levels), grid_.fraction(), ~Brick(0), &counts_);
    if (voxels != 0) out->push_back({morton(cube.coordinate), voxels});
  }

  Grid grid_;
  DecisionCounts counts_;  // unused: the kernel counts for the report of a bake
  std::vector<std::array<TriangleList, 8>> lists_;
};

LatticePoint voxel_corner(const Grid& grid, const Cube& cube) {
  const int shift = grid.levels - cube.level;
  return {cube.coordinate.x << shift, cube.coordinate.y << shift, cube.coordinate.z << shift};
}

// The same grid with voxel size 1 and its corner at zero: world units are voxels.
Grid voxel_grid(Grid grid) {
  grid.kind = Grid::Kind::kBox;
  grid.origin = Point(0);
  grid.voxel_size = 1;
  return grid;
}

std::vector<Triangle> in_voxels(const std::vector<LatticeTriangle>& snapped, int fraction) {
  std::vector<Triangle> out(snapped.size());
  const double step = 1 / double(int64_t(1) << fraction);
  for (size_t i = 0; i < snapped.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) out[i].v[k] = step * Point(snapped[i].v[k]);
  }
  return out;
}

template <class Test, class AnyTriangle>
void descend(const Test& test, const std::vector<AnyTriangle>& triangles, const Grid& grid,
             const Cube& cube, BrickList* out) {
  std::vector<typename Test::Setup> setups;
  setups.reserve(triangles.size());
  for (const AnyTriangle& t : triangles) setups.push_back(test.setup(t));
  CubeDescent<Test>(test, setups).run(voxel_corner(grid, cube), grid.levels - cube.level, out);
}

// A method on world coordinates; make_test(grid) returns its overlap test.
template <class MakeTest>
Method peer(const char* name, const Grid& grid, const MakeTest& make_test) {
  const auto world_test = make_test(grid), snapped_test = make_test(voxel_grid(grid));
  return {name, false, [=](const CellWork& work, Input input, BrickList* out) {
            if (input == Input::kWorld)
              return descend(world_test, work.world, grid, work.cube, out);
            descend(snapped_test, in_voxels(work.snapped, grid.fraction()), grid, work.cube, out);
          }};
}

#ifdef SVDAG_HAS_CGAL
template <class Run>
Method cgal(const char* name, const Grid& grid, const Run& run) {
  return {name, true, [=](const CellWork& work, Input input, BrickList* out) {
            const LatticePoint corner = voxel_corner(grid, work.cube);
            const int log2 = grid.levels - work.cube.level;
            if (input == Input::kWorld) return run(grid, work.world, corner, log2, out);
            run(voxel_grid(grid), in_voxels(work.snapped, grid.fraction()), corner, log2, out);
          }};
}
#endif

}  // namespace

std::vector<Method> make_methods(const Grid& grid) {
  std::vector<Method> methods;
  methods.push_back({"svdag", false, [=](const CellWork& work, Input, BrickList* out) {
                       BuilderDescent(grid).run(work.cube, work.snapped, out);
                     }});
  methods.push_back({"svdag + reduction", false, [=](const CellWork& work, Input, BrickList* out) {
                       voxelize_window(grid, {}, work.cube, work.snapped,
                                       [&](const LatticePoint& at, Brick brick) {
                                         out->push_back({morton(at), brick});
                                       });
                     }});
  methods.push_back({"int128", false, [=](const CellWork& work, Input, BrickList* out) {
                       descend(IntegerTest(grid.fraction()), work.snapped, grid, work.cube, out);
                     }});
  methods.push_back(peer("AM float", grid, [](const Grid& g) { return AkenineMoller<float>(g); }));
  methods.push_back(
      peer("AM double", grid, [](const Grid& g) { return AkenineMoller<double>(g); }));
  methods.push_back(peer("SS float", grid, [](const Grid& g) { return SchwarzSeidel<float>(g); }));
  methods.push_back(
      peer("SS double", grid, [](const Grid& g) { return SchwarzSeidel<double>(g); }));
  methods.push_back(peer("SS double, ε=1e-6", grid,
                         [](const Grid& g) { return SchwarzSeidel<double>(g, 1e-6); }));
#ifdef SVDAG_HAS_CGAL
  methods.push_back(cgal("CGAL EPICK", grid, cgal_epick));
  methods.push_back(cgal("CGAL EPECK", grid, cgal_epeck));
#endif
  return methods;
}

}  // namespace svdag::bench
