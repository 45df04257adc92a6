#include "builder/cache/cell_key.h"

#include <sodium/crypto_generichash.h>

#include <algorithm>
#include <span>
#include <vector>

namespace svdag {
namespace {

constexpr int64_t kVersion = 2;  // to be changed when the sub-DAG of the same triangles changes

// Three vertices, relative to the cell's corner, and whether they are of a sheet.
using Words = std::array<int64_t, 10>;

void put_selection(const Grid& grid, const Cube& cube, std::vector<int64_t>* text) {
  const int shift = grid.levels - cube.level;
  const int64_t side = int64_t(1) << shift;
  for (int a = 0; a < 3; ++a) {
    const int64_t corner = cube.coordinate[a] << shift;
    text->push_back(std::clamp<int64_t>(grid.selection.min[a] - corner, 0, side));
    text->push_back(std::clamp<int64_t>(grid.selection.max[a] - corner, 0, side));
  }
}

// Rotates the vertices, which keeps the orientation, so that the smallest is the first.
void put_first_vertex_first(Words* words) {
  const auto vertex = [&](size_t i) { return std::span(*words).subspan(3 * i, 3); };
  size_t first = 0;
  for (size_t i = 1; i < 3; ++i) {
    if (std::ranges::lexicographical_compare(vertex(i), vertex(first))) first = i;
  }
  std::rotate(words->begin(), words->begin() + 3 * int(first), words->begin() + 9);
}

}  // namespace

CellKey cell_key(const Grid& grid, Rule rule, const Cube& cube, const TriangleList& list,
                 int32_t winding) {
  const LatticePoint corner = cube.corner(grid.levels);
  std::vector<Words> triangles;
  triangles.reserve(list.size());
  for (const ListedTriangle& entry : list) {
    Words& words = triangles.emplace_back();
    for (size_t i = 0; i < 9; ++i)
      words[i] = entry.triangle->triangle.v[i / 3][int(i % 3)] - corner[int(i % 3)];
    words[9] = entry.triangle->triangle.sheet;
    if (is_solid(rule)) put_first_vertex_first(&words);
  }
  std::sort(triangles.begin(), triangles.end());
  if (!is_solid(rule))
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());

  std::vector<int64_t> text = {kVersion, int64_t(rule), grid.fraction(), grid.levels - cube.level};
  put_selection(grid, cube, &text);
  if (is_solid(rule)) text.push_back(winding);
  text.push_back(int64_t(triangles.size()));
  for (const Words& words : triangles) text.insert(text.end(), words.begin(), words.end());

  CellKey key;
  crypto_generichash_blake2b(reinterpret_cast<unsigned char*>(key.words.data()), sizeof key.words,
                             reinterpret_cast<const unsigned char*>(text.data()),
                             text.size() * sizeof text[0], nullptr, 0);
  return key;
}

}  // namespace svdag
