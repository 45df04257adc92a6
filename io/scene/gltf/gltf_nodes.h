// The node hierarchy of a glTF file: which nodes are drawn, and where.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "io/affine.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/mesh/mesh_reader.h"

namespace svdag {

// Scale, then rotation (a quaternion x, y, z, w of any non-zero length), then translation; in a
// fixed order of operations, as in io/affine.h:
//   rotation     of (x, y, z, w) with n = ((x*x + y*y) + z*z) + w*w:
//                diagonal (((w*w + x*x) - y*y) - z*z) / n, cyclic; others (2 * (x*y - w*z)) / n ...
// Dividing by n normalises the quaternion inside the products, so that quarter turns come out as
// exact zeros and ones. Rejected: dividing by sqrt(n) first, which leaves 2e-16 there.
struct Trs {
  std::array<double, 3> translation{0, 0, 0};
  std::array<double, 4> rotation{0, 0, 0, 1};
  std::array<double, 3> scale{1, 1, 1};

  Affine affine() const;
};

constexpr int kMaxNodeDepth = 1000;

// A 4x4 matrix, column by column. Error (kBadInput): it is a projection.
Affine affine_of_columns(const std::array<double, 16>& columns, const std::string& path);
// The transform of a node into the space of its parent.
Affine local_transform(const JsonObject& node);

using NodeVisitor = std::function<void(const JsonObject& node, const std::string& name,
                                       const Affine& world, bool included)>;

// Calls `visit` for every node that has a mesh and is not excluded, depth first, a node before its
// children. `name`: the node's, or its mesh's if the node has none; `included`: whether the node,
// an ancestor or the file is included, by name or because everything is. The roots are those of the
// default scene (`scene`, else the first; all roots without a scene). A node that is reached twice
// (cycles too) or is deeper than kMaxNodeDepth is an Error. `place`: into the world.
// Returns the number of nodes that the file hides (KHR_node_visibility), which are skipped with
// what is below them unless options.hidden.
uint64_t visit_nodes(const GltfDocument& document, const ReadOptions& options, const Affine& place,
                     const NodeVisitor& visit);

// The instances of one node: itself, or those of EXT_mesh_gpu_instancing. Each of its
// attributes, including application-specific ones (_ID), has an element for each instance. Missing
// attributes (TRANSLATION, ROTATION, SCALE) are the identity.
class InstanceStream {
 public:
  InstanceStream(const JsonObject& node, const Affine& world, GltfBuffers* buffers);
  // One, in the world.
  InstanceStream() = default;

  uint64_t count() const { return count_; }
  // The next instance's transform into the world; called count() times.
  Affine next();

 private:
  Affine world_;
  uint64_t count_ = 1;
  bool instanced_ = false;
  const std::string* path_ = nullptr;
  std::optional<ElementStream> translation_, rotation_, scale_;
};

}  // namespace svdag
