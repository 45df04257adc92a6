// The methods that the accuracy bench compares.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/accuracy_case.h"

namespace svdag::bench {

enum class Input { kWorld, kSnapped };

struct Method {
  std::string name;
  bool slow;  // CGAL: runs only on every eighth cell, and not on whole bakes
  // Voxelizes one cell, with the world triangles or the snapped ones (as doubles in voxel units).
  std::function<void(const CellWork&, Input, BrickList*)> run;
};

// The methods in the order of the tables; without CGAL, its methods are missing.
std::vector<Method> make_methods(const Grid& grid);

}  // namespace svdag::bench
