// A scene with what colours it, snapped: triangles in memory, or in bins if they are many.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "builder/colours/cube_share.h"
#include "builder/colours/painted_bins.h"
#include "builder/workspace/workspace.h"
#include "io/lattice.h"
#include "io/scene/scene.h"

namespace svdag {

struct PaintedScene {
  SceneCounts counts;
  Paints paints;
  std::vector<PaintedTriangle> triangles;
  MemoryBudget::Reservation memory;  // of `triangles`, prepared
  std::optional<PaintedBins> bins;
  // If set, is called with each triangle that meets the grid, and none is kept.
  std::function<void(const PaintedTriangle&)> visit;
  LatticeBox box;  // of the triangles that meet the grid
  bool is_empty = true;
  TexelDensity density;
};

// K: a cube spans one to two texels.
int level_for(const TexelDensity& density, int levels);

class SceneReader {
 public:
  // Beyond `max_triangles`, of `triangle_bytes` in memory each, all go to bins of `bin_depth`.
  SceneReader(const Grid& grid, uint64_t max_triangles, uint64_t triangle_bytes, int bin_depth,
              Workspace* workspace, PaintedScene* out);

  void read(const TriangleBatch& batch);

 private:
  static constexpr const char* kPurpose = "triangles with colours";

  // A paint as a key: its image is kept alive by the paints.
  using PaintKey = std::tuple<const LinearImage*, Wrap, Wrap, bool, std::array<double, 3>>;

  uint32_t number_of(const Paint& paint);
  void paint_corners(const TriangleBatch& batch, size_t k, uint32_t paint, PaintedTriangle* t);
  void keep(const PaintedTriangle& t);

  const Grid& grid_;
  Lattice lattice_;
  LatticeBox whole_;
  uint64_t max_triangles_, triangle_bytes_;
  int bin_depth_;
  Workspace& workspace_;
  PaintedScene& out_;
  std::map<PaintKey, uint32_t> numbers_;  // of out_.paints
};

}  // namespace svdag
