// The parts of a scene that are not closed surfaces: they bound no solid (--open surface).
//
// If the whole scene is closed, none is open: its parts may close each other. Otherwise each object
// is tested by itself, or each file where it has no objects; parts of one name are one part. A
// layer is always tested by itself: the walls of a room may be closed together, and each open.
#pragma once

#include <set>
#include <string>

#include "io/grid.h"
#include "io/scene/boundary_chain.h"
#include "io/scene/scene.h"

namespace svdag {

// Whether a surface is closed for a solid rule, by an EdgeSum or a BoundaryChain.
template <class Sum>
bool is_closed(const Sum& sum, Rule rule) {
  return rule == Rule::kSolid ? sum.is_closed() : sum.is_closed_mod_2();
}

class OpenParts {
 public:
  // Reads the scene, snapped to `grid`, once, and again if edges do not match one by one.
  OpenParts(const Scene& scene, const Grid& grid, Rule rule);
  // The layers that are open.
  OpenParts(const Scene& scene, const Grid& grid, Rule rule, LayerKind layers);
  OpenParts() = default;  // none

  bool contains(const TriangleBatch& batch) const {
    return !names_.empty() && names_.contains(name_of(batch));
  }
  size_t size() const { return names_.size(); }

 private:
  std::string name_of(const TriangleBatch& batch) const {
    if (layers_ != LayerKind::kNone) return std::string(part_name(batch, part_of(layers_)));
    return std::string(batch.mesh.empty() ? batch.file : batch.mesh);
  }

  LayerKind layers_ = LayerKind::kNone;
  std::set<std::string> names_;
};

}  // namespace svdag
