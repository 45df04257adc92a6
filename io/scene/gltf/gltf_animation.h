// The pose of a glTF scene at a time (3.11 of the specification): channels of animations give nodes
// another translation, rotation, scale or other weights of morph targets.
//
// They are written into the nodes of the document, so that what reads them (the walk over nodes,
// skins, morph targets) needs to know nothing of time. Before its first key a channel has the first
// value, after its last key the last one. Between keys values are interpolated in double, in a
// fixed order of operations: (1 - u) * a + u * b; rotations by slerp the short way, of normalised
// quaternions (linear where they are closer than kClose), io/trigonometry.h; cubic splines by the
// Hermite polynomials of the specification.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/mesh/mesh_reader.h"

namespace svdag {

// Poses the document, which was loaded with animations. Returns the number of channels that are not
// followed (KHR_animation_pointer). An animation that does not exist is an Error (kUsage), a broken
// one, or a channel of a node with a matrix, is one of kBadInput.
uint64_t pose_at(const PoseTime& when, GltfDocument* document, GltfBuffers* buffers);

// The animations of a glTF file, in its order.
std::vector<Animation> gltf_animations(const File& content, const ReadOptions& options);

}  // namespace svdag
