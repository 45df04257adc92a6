// A mesh put together from curved rectangular patches, each a grid of quads.
//
// A patch is a function of (u, v) in [0, 1]^2; how finely it is divided follows from its size and
// from one density for the whole mesh, so a scene is described once and has any number of
// triangles. Positions are computed on demand.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tests/scenes/mesh.h"

namespace svdag::scenes {

struct Patch {
  std::function<Point(double u, double v)> surface;
  double width, height;  // metres along u and v
  // The divisions are multiples of these: 1 for what is flat, more for what is round.
  uint32_t multiple_u = 1, multiple_v = 1;
  const char* part = "stone";
};

class PatchMesh : public Mesh {
 public:
  // Divides the patches so finely that there are as many triangles as possible, but at most
  // `triangles`. Fewer than the coarsest division needs is an Error (kUsage).
  PatchMesh(std::vector<Patch> patches, uint64_t triangles);

  uint64_t vertices() const override { return pieces_.back().first_vertex; }
  uint64_t faces() const override { return pieces_.back().first_face; }
  Point vertex(uint64_t i) const override;
  Face face(uint64_t i) const override;
  std::string part(uint64_t i) const override { return patches_[piece_of(i)].part; }

 private:
  struct Piece {
    uint64_t first_vertex, first_face;
    uint32_t columns, rows;
  };
  size_t piece_of(uint64_t face) const;
  static std::vector<Piece> divide(const std::vector<Patch>& patches, double density);

  std::vector<Patch> patches_;
  std::vector<Piece> pieces_;  // one per patch, and the totals
};

}  // namespace svdag::scenes
