#include "builder/colours/painted_scene.h"

#include <algorithm>

#include "builder/colours/colour_pass.h"

namespace svdag {
namespace {

std::array<uint16_t, 3> colour_of(const TriangleBatch& batch) {
  if (!batch.colour) return {kWhite16, kWhite16, kWhite16};
  return {light16_of_code(batch.colour->r), light16_of_code(batch.colour->g),
          light16_of_code(batch.colour->b)};
}

}  // namespace

int level_for(const TexelDensity& density, int levels) {
  if (density.area == 0 || density.texels == 0) return levels;
  double texels = double(density.texels) / double(density.area);
  int level = levels;
  for (; texels < 1 && level > kMinColourLevel; --level) texels *= 2;
  return level;
}

SceneReader::SceneReader(const Grid& grid, uint64_t max_triangles, uint64_t triangle_bytes,
                         int bin_depth, Workspace* workspace, PaintedScene* out)
    : grid_(grid),
      lattice_(grid),
      whole_(grid.closed(grid.whole())),
      max_triangles_(max_triangles),
      triangle_bytes_(triangle_bytes),
      bin_depth_(bin_depth),
      workspace_(*workspace),
      out_(*out) {
  out_.memory = workspace_.budget()->reserve(0, kPurpose);
}

void SceneReader::read(const TriangleBatch& batch) {
  if (batch.cut != nullptr && batch.cut->is_transparent()) return;
  const std::array<uint16_t, 3> plain = colour_of(batch);
  const uint32_t paint = batch.paint != nullptr ? number_of(*batch.paint) : kOneColour;
  for (size_t k = 0; k < batch.triangles.size(); ++k) {
    PaintedTriangle t;
    for (size_t i = 0; i < 3; ++i) {
      t.corners[i].position = lattice_.snap(batch.triangles[k].v[i]);
      t.corners[i].colour = plain;
    }
    if (batch.paint != nullptr) paint_corners(batch, k, paint, &t);
    sort_corners(&t);
    out_.density.add(t, grid_.fraction());
    const LatticeBox box = box_of(t.triangle());
    if (!box.meets(whole_)) continue;
    if (out_.is_empty) out_.box = box;
    out_.is_empty = false;
    out_.box.add(box);
    keep(t);
  }
}

uint32_t SceneReader::number_of(const Paint& paint) {
  const PaintKey key = {paint.image.get(), paint.wrap_u, paint.wrap_v, paint.nearest, paint.factor};
  const auto [entry, is_new] = numbers_.try_emplace(key, uint32_t(out_.paints.size()));
  if (is_new) out_.paints.push_back(paint);
  return entry->second;
}

void SceneReader::paint_corners(const TriangleBatch& batch, size_t k, uint32_t paint,
                                PaintedTriangle* t) {
  const CornerColours& colours = batch.corner_colours[k];
  if (batch.paint->image && !std::ranges::all_of(batch.texture[k], is_placeable)) {
    // Nowhere in its texture, so it has the colour of its material.
    Paint plain;
    const std::array<uint16_t, 3> colour = colour_of(batch);
    for (size_t c = 0; c < 3; ++c) plain.factor[c] = double(colour[c]) / kWhite16;
    TriangleBatch untextured = batch;
    untextured.paint = &plain;
    return paint_corners(untextured, k, number_of(plain), t);
  }
  const auto one = one_colour(*batch.paint, colours);
  t->paint = one ? kOneColour : paint;
  for (size_t i = 0; i < 3; ++i) {
    t->corners[i].colour = one ? *one : colours[i];
    if (batch.paint->image) t->corners[i].texture = batch.texture[k][i];
  }
}

void SceneReader::keep(const PaintedTriangle& t) {
  if (out_.visit) return out_.visit(t);
  if (out_.bins) return out_.bins->add(t);
  if (out_.triangles.size() == max_triangles_) {
    out_.bins.emplace(grid_.levels, Cube(), bin_depth_, workspace_.scratch());
    for (const PaintedTriangle& kept : out_.triangles) out_.bins->add(kept);
    out_.triangles = {};
    out_.memory.release();
    return out_.bins->add(t);
  }
  if (out_.triangles.size() == out_.triangles.capacity()) {
    const size_t room = size_t(
        std::min<uint64_t>(max_triangles_, std::max<size_t>(1024, 2 * out_.triangles.size())));
    out_.memory.resize(room * triangle_bytes_, kPurpose);
    out_.triangles.reserve(room);
  }
  out_.triangles.push_back(t);
}

}  // namespace svdag
