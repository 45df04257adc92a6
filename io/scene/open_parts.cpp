#include "io/scene/open_parts.h"

#include <map>

#include "io/lattice.h"

namespace svdag {
namespace {

template <class Sum, class NameOf>
std::map<std::string, Sum> sums_of_parts(const Scene& scene, const Grid& grid,
                                         const NameOf& name_of, Sum* all) {
  const Lattice lattice(grid);
  std::map<std::string, Sum> sums;
  scene.stream([&](const TriangleBatch& batch) {
    Sum& part = sums[name_of(batch)];
    for (const Triangle& t : batch.triangles) {
      const LatticeTriangle snapped{
          {lattice.snap(t.v[0]), lattice.snap(t.v[1]), lattice.snap(t.v[2])}};
      part.add(snapped);
      all->add(snapped);
    }
  });
  return sums;
}

}  // namespace

OpenParts::OpenParts(const Scene& scene, const Grid& grid, Rule rule) {
  EdgeSum edges;
  sums_of_parts(
      scene, grid, [](const TriangleBatch&) { return ""; }, &edges);
  if (is_closed(edges, rule)) return;
  BoundaryChain chain;
  const auto chains = sums_of_parts(
      scene, grid, [&](const TriangleBatch& batch) { return name_of(batch); }, &chain);
  if (is_closed(chain, rule)) return;
  for (const auto& [name, part] : chains) {
    if (!is_closed(part, rule)) names_.insert(name);
  }
}

OpenParts::OpenParts(const Scene& scene, const Grid& grid, Rule rule, LayerKind layers)
    : layers_(layers) {
  const auto name = [&](const TriangleBatch& batch) { return name_of(batch); };
  EdgeSum all_edges;
  for (const auto& [layer, edges] : sums_of_parts(scene, grid, name, &all_edges)) {
    if (!is_closed(edges, rule)) names_.insert(layer);
  }
  if (names_.empty()) return;
  BoundaryChain all;
  for (const auto& [layer, chain] : sums_of_parts(scene, grid, name, &all)) {
    if (is_closed(chain, rule)) names_.erase(layer);
  }
}

}  // namespace svdag
