// The node hierarchy of a glTF file: which nodes are drawn, and where.
#pragma once

#include <functional>
#include <string>

#include "io/scene/gltf/gltf_buffers.h"
#include "io/scene/gltf/gltf_document.h"
#include "io/scene/gltf/gltf_elements.h"
#include "io/scene/gltf/gltf_transform.h"
#include "io/scene/mesh/mesh_reader.h"

namespace svdag {

using NodeVisitor = std::function<void(const JsonObject& node, const std::string& name,
                                       const Affine& world, bool included)>;

// Calls `visit` for every node that has a mesh and is not excluded, depth first, a node before its
// children. `name`: the node's, or its mesh's if the node has none; `included`: whether the node,
// an ancestor or the file is included, by name or because everything is. The roots are those of the
// default scene (`scene`, else the first; all roots without a scene). A node that is reached twice
// (cycles too) or is deeper than 1000 levels is an Error.
void visit_nodes(const GltfDocument& document, const ReadOptions& options,
                 const NodeVisitor& visit);

// The instances of one node: itself, or those of EXT_mesh_gpu_instancing, as many as each of its
// attributes has elements, including application-specific ones (_ID). Missing attributes
// (TRANSLATION, ROTATION, SCALE) are the identity.
class InstanceStream {
 public:
  InstanceStream(const JsonObject& node, const Affine& world, GltfBuffers* buffers);

  uint64_t count() const { return count_; }
  // The next instance's transform into the world; called count() times.
  Affine next();

 private:
  Affine world_;
  uint64_t count_ = 1;
  bool instanced_ = false;
  const std::string* path_;
  std::optional<ElementStream> translation_, rotation_, scale_;
};

}  // namespace svdag
