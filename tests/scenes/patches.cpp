#include "tests/scenes/patches.h"

#include <algorithm>
#include <cmath>

#include "streaming/error.h"

namespace svdag::scenes {
namespace {

uint32_t divisions(double metres, double density, uint32_t multiple) {
  return multiple * uint32_t(std::max(1.0, std::floor(metres * density / multiple + 0.5)));
}

// The axis closest to the normal of the patch in its middle.
size_t facing_axis(const Patch& patch) {
  const Point middle = patch.surface(0.5, 0.5);
  const Point a = patch.surface(0.625, 0.5) - middle, b = patch.surface(0.5, 0.625) - middle;
  const double normal[] = {std::abs(a.y * b.z - a.z * b.y), std::abs(a.z * b.x - a.x * b.z),
                           std::abs(a.x * b.y - a.y * b.x)};
  return size_t(std::max_element(normal, normal + 3) - normal);
}

}  // namespace

std::vector<PatchMesh::Piece> PatchMesh::divide(const std::vector<Patch>& patches, double density) {
  std::vector<Piece> pieces;
  Piece next{0, 0, 0, 0};
  for (const Patch& patch : patches) {
    next.columns = divisions(patch.width, density, patch.multiple_u);
    next.rows = divisions(patch.height, density, patch.multiple_v);
    pieces.push_back(next);
    next.first_vertex += uint64_t(next.columns + 1) * (next.rows + 1);
    next.first_face += 2 * uint64_t(next.columns) * next.rows;
  }
  pieces.push_back(next);
  return pieces;
}

PatchMesh::PatchMesh(std::vector<Patch> patches, uint64_t triangles)
    : patches_(std::move(patches)), pieces_(divide(patches_, 0)) {
  if (faces() > triangles)
    fail_usage("--triangles: this scene needs at least " + std::to_string(faces()) + " triangles");
  // The number of faces grows with the density: bisect.
  double low = 0, high = 1 << 16;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (divide(patches_, middle).back().first_face <= triangles ? low : high) = middle;
  }
  pieces_ = divide(patches_, low);
}

PatchMesh::Place PatchMesh::place(uint64_t vertex) const {
  const auto after =
      std::upper_bound(pieces_.begin(), pieces_.end(), vertex,
                       [](uint64_t n, const Piece& p) { return n < p.first_vertex; });
  const Piece& piece = *(after - 1);
  const uint64_t at = vertex - piece.first_vertex;
  return {patches_[size_t(after - 1 - pieces_.begin())],
          double(at % (piece.columns + 1)) / piece.columns,
          double(at / (piece.columns + 1)) / piece.rows};
}

Point PatchMesh::vertex(uint64_t i) const {
  const Place at = place(i);
  return at.patch.surface(at.u, at.v);
}

Charts PatchMesh::charts(uint64_t i) const {
  const auto [patch, u, v] = place(i);
  Charts charts{{u, v}, {u * patch.chart_width, v * patch.height}};
  if (patch.cell > 0)
    charts.whole = {((patch.cell - 1) % 2 + u) / 2, ((patch.cell - 1) / 2 + v) / 2};
  if (patch.mapping == Mapping::kPlane) {
    const Point p = patch.surface(u, v);
    const size_t facing = facing_axis(patch);
    charts.along = {facing == 0 ? p.z : p.x, facing == 1 ? p.z : p.y};
  }
  return charts;
}

size_t PatchMesh::piece_of(uint64_t face) const {
  const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), face,
                                      [](uint64_t n, const Piece& p) { return n < p.first_face; });
  return size_t(after - 1 - pieces_.begin());
}

Face PatchMesh::face(uint64_t i) const {
  const Piece& piece = pieces_[piece_of(i)];
  Face f = quad_face(piece.columns, i - piece.first_face);
  for (uint64_t& v : f) v += piece.first_vertex;
  return f;
}

}  // namespace svdag::scenes
