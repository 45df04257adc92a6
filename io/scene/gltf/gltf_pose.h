// The pose of a glTF scene at rest: how morph targets (3.7.2.2 of the specification), then a skin
// (3.7.3) move the vertices of a primitive.
//
//   p' = p + w0 * t0 + w1 * t1 ...    over the morph targets, in order
//   v  = (sum of wi * Mi(p')) / sum of wi    over the joints of JOINTS_0, JOINTS_1, ..., in order
//   Mi = compose(Gi, Bi)   Gi: the joint's transform into the world; Bi: its inverse bind matrix
//
// in double, in this order (io/affine.h). A skinned vertex is in the world: the transform and the
// instances of the node that draws it do not apply. Joints count wherever they are in the file:
// hidden, excluded, in another scene. A vertex whose weights have no positive sum is placed by the
// node. Nothing is held except the joints of one skin: positions, targets, joints and weights are
// streamed. Rejected: blending the matrices of a vertex first (more operations for the same
// result).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "io/affine.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"

namespace svdag {

class GltfPose {
 public:
  GltfPose(const GltfDocument& document, GltfBuffers* buffers, MemoryBudget* budget)
      : document_(document),
        buffers_(*buffers),
        budget_(*budget),
        memory_(budget->reserve(0, kPurpose)) {}

  // Whether a skin places `primitive`, which `node` draws, in the world.
  static bool is_skinned(const JsonObject& node, const JsonObject& primitive);
  // Whether a skin or morph targets move its vertices.
  bool moves(const JsonObject& node, const JsonObject& primitive) const;
  // Passes on its vertices, in the world if it is skinned, else as the node has to place them.
  // `positions`: as stored. `world`: of the node.
  void visit_vertices(const JsonObject& node, const JsonObject& primitive,
                      const Accessor& positions, const Affine& world,
                      const std::function<void(const Point&)>& visit);

  // Where the whole scene is from here on; at first as it is.
  void place(const Affine& place);
  // Number of vertices passed on whose weights have no positive sum.
  uint64_t unweighted() const { return unweighted_; }

 private:
  static constexpr const char* kPurpose = "joints and morph targets";

  std::vector<double> weights_of(const JsonObject& node) const;
  std::vector<class MorphStream> morphs_of(const JsonObject& node, const JsonObject& primitive,
                                           uint64_t vertices, MemoryBudget::Reservation* memory);
  std::vector<class JointStream> joints_of(const JsonObject& primitive, uint64_t vertices);
  // The matrices of skin `index`.
  const std::vector<Affine>& skin(uint64_t index);
  Affine world_of(uint64_t node);

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  MemoryBudget& budget_;
  MemoryBudget::Reservation memory_;
  Affine place_;
  std::vector<uint32_t> parents_;       // 1 + the parent of each node, 0: a root
  std::map<uint64_t, Affine> worlds_;   // of nodes that joints need
  std::optional<uint64_t> skin_index_;  // of skin_
  std::vector<Affine> skin_;
  uint64_t unweighted_ = 0;
};

}  // namespace svdag
