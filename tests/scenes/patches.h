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

// How the metres of a chart follow a patch (Charts::along).
enum class Mapping {
  kPlane,   // by the coordinate plane that the patch faces, so that patches in a plane continue
  kLengths  // u * chart_width, v * height
};

struct Patch {
  std::function<Point(double u, double v)> surface;
  double width, height;  // metres along u and v
  // The divisions are multiples of these: 1 for what is flat, more for what is round.
  uint32_t multiple_u = 1, multiple_v = 1;
  const char* part = "stone";
  const char* material = "limestone";
  Mapping mapping = Mapping::kPlane;
  double chart_width = 0;
  uint32_t cell = 0;  // 1 .. 4: the quarter of an atlas that the patch covers
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
  std::string part(uint64_t i) const override { return patch_of_face(i).part; }
  std::string material(uint64_t i) const override { return patch_of_face(i).material; }
  Charts charts(uint64_t i) const override;

 protected:
  // A vertex: its patch and where it is on it.
  struct Place {
    const Patch& patch;
    double u, v;
  };
  Place place(uint64_t vertex) const;

 private:
  struct Piece {
    uint64_t first_vertex, first_face;
    uint32_t columns, rows;
  };
  size_t piece_of(uint64_t face) const;
  const Patch& patch_of_face(uint64_t face) const { return patches_[piece_of(face)]; }
  static std::vector<Piece> divide(const std::vector<Patch>& patches, double density);

  std::vector<Patch> patches_;
  std::vector<Piece> pieces_;  // one per patch, and the totals
};

}  // namespace svdag::scenes
