// The methods of the accuracy bench by name.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/accuracy_case.h"

namespace svdag::bench {

enum class Input { kWorld, kSnapped };

struct Method {
  std::string name;
  bool slow;  // CGAL: run on every eighth cell only, and not on a whole bake
  // Voxelizes one cell; the world triangles, or the snapped ones as doubles in voxel units.
  std::function<void(const CellWork&, Input, BrickList*)> run;
};

// In the order of the tables; CGAL's are missing where it was not built in.
std::vector<Method> make_methods(const Grid& grid);

}  // namespace svdag::bench
