#include "io/scene/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr double kNoise = 1e-5;  // in the last row of a matrix: of float inverses, for example

// A quaternion that can be normalised: its squared length neither vanishes nor overflows.
void check_rotation(const Trs& trs, const std::string& path) {
  double n = 0;
  for (const double q : trs.rotation) n += q * q;
  if (!(std::isnormal(n))) fail_input(path, "has a node whose rotation is not a quaternion");
}

class NodeWalk {
 public:
  NodeWalk(const GltfDocument& document, const ReadOptions& options, const Affine& place,
           const NodeVisitor& visit)
      : document_(document),
        options_(options),
        place_(place),
        visit_(visit),
        reached_(document.root().array("nodes").size()) {}

  void scene(uint64_t index) {
    const JsonObject scene = document_.element("scenes", index);
    for (const auto& root : scene.array("nodes")) start(scene.index(root, "nodes"));
  }

  uint64_t hidden() const { return hidden_; }

  // Without a scene: every node without a parent. A cycle has no such node and is never reached.
  void all_roots() {
    std::vector<bool> is_child(reached_.size());
    for (uint64_t i = 0; i < reached_.size(); ++i) {
      const JsonObject node = document_.element("nodes", i);
      for (const auto& child : node.array("children")) {
        const uint64_t c = node.index(child, "children");
        if (c < is_child.size()) is_child[size_t(c)] = true;
      }
    }
    for (uint64_t i = 0; i < reached_.size(); ++i) {
      if (!is_child[size_t(i)]) start(i);
    }
    if (skipped_ == 0 && std::find(reached_.begin(), reached_.end(), false) != reached_.end()) {
      fail_input(document_.file->path(), "has nodes that are their own ancestors");
    }
  }

 private:
  void start(uint64_t root) { node(root, place_, options_.file_included, 0); }

  // `chosen`: an ancestor, or the file, matched --include.
  void node(uint64_t index, const Affine& parent, bool chosen, int depth) {
    const JsonObject object = document_.element("nodes", index);
    if (reached_[size_t(index)]) fail(index, "is reached twice: the hierarchy must be a tree");
    if (depth > kMaxNodeDepth) fail(index, "is too deep in the hierarchy");
    reached_[size_t(index)] = true;
    const std::string name = name_of_node(object);
    const bool included = options_.names->includes(PartKind::kObject, name);  // records a match
    if (options_.names->excludes(PartKind::kObject, name)) {
      ++skipped_;
      return;
    }
    if (is_hidden(object)) {
      ++hidden_;
      ++skipped_;
      return;
    }
    chosen = chosen || included;
    const Affine world = compose(parent, local_transform(object));
    if (object.has("mesh")) visit_(object, name, world, chosen);
    for (const auto& child : object.array("children")) {
      node(object.index(child, "children"), world, chosen, depth + 1);
    }
  }

  bool is_hidden(const JsonObject& node) const {
    if (options_.hidden) return false;
    const auto visibility = node.extension("KHR_node_visibility");
    return visibility && visibility->has("visible") && !visibility->flag("visible");
  }

  std::string name_of_node(const JsonObject& node) const {
    const std::string& name = node.text("name");
    if (!name.empty() || !node.has("mesh")) return name;
    return document_.element("meshes", node.whole_number("mesh")).text("name");
  }

  [[noreturn]] void fail(uint64_t index, const char* what) const {
    fail_input(document_.file->path(), "has nodes[" + std::to_string(index) + "], which " + what);
  }

  const GltfDocument& document_;
  const ReadOptions& options_;
  const Affine place_;
  const NodeVisitor& visit_;
  std::vector<bool> reached_;
  uint64_t skipped_ = 0;  // with all below them
  uint64_t hidden_ = 0;   // of these, by the file
};

}  // namespace

Affine affine_of_columns(const std::array<double, 16>& columns, const std::string& path) {
  Affine a;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) a.m[r][c] = columns[size_t(4 * c + r)];
  }
  for (const size_t c : {3u, 7u, 11u, 15u}) {
    if (!(std::abs(columns[c] - (c == 15)) <= kNoise))
      fail_input(path, "has a node whose matrix is a projection");
  }
  return a;
}

Affine local_transform(const JsonObject& node) {
  std::array<double, 16> columns;
  if (node.numbers("matrix", columns)) return affine_of_columns(columns, node.path());
  Trs trs;
  node.numbers("translation", trs.translation);
  node.numbers("rotation", trs.rotation);
  node.numbers("scale", trs.scale);
  check_rotation(trs, node.path());
  return trs.affine();
}

Affine Trs::affine() const {
  const auto [x, y, z, w] = rotation;
  const double n = ((x * x + y * y) + z * z) + w * w;
  Affine a;
  a.m[0] = {(((w * w + x * x) - y * y) - z * z) / n, (2 * (x * y - w * z)) / n,
            (2 * (x * z + w * y)) / n, 0};
  a.m[1] = {(2 * (x * y + w * z)) / n, (((w * w + y * y) - z * z) - x * x) / n,
            (2 * (y * z - w * x)) / n, 0};
  a.m[2] = {(2 * (x * z - w * y)) / n, (2 * (y * z + w * x)) / n,
            (((w * w + z * z) - x * x) - y * y) / n, 0};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) a.m[r][c] *= scale[c];
    a.m[r][3] = translation[r];
  }
  return a;
}

uint64_t visit_nodes(const GltfDocument& document, const ReadOptions& options, const Affine& place,
                     const NodeVisitor& visit) {
  const JsonObject root = document.root();
  NodeWalk walk(document, options, place, visit);
  if (root.array("scenes").empty()) {
    walk.all_roots();
  } else {
    walk.scene(root.whole_number("scene", 0));
  }
  return walk.hidden();
}

InstanceStream::InstanceStream(const JsonObject& node, const Affine& world, GltfBuffers* buffers)
    : world_(world), path_(&node.path()) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) return;
  instanced_ = true;
  count_ = 0;  // without an attribute the count is unknown
  const JsonObject attributes = extension->object("attributes");
  bool counted = false;
  for (const std::string& name : attributes.names()) {
    const bool vector = name == "TRANSLATION" || name == "SCALE";
    const Accessor accessor = buffers->accessor(attributes.whole_number(name.c_str()),
                                                vector               ? "VEC3"
                                                : name == "ROTATION" ? "VEC4"
                                                                     : GltfBuffers::kAnyType);
    // Instances multiply triangles, so each must have bytes in the file.
    if (accessor.base.blob == nullptr) fail_input(*path_, "has instances without data");
    if (counted && accessor.count() != count_)
      fail_input(*path_, "has instances with attributes of different numbers of elements");
    counted = true;
    count_ = accessor.count();
    if (name == "TRANSLATION") translation_.emplace(accessor);
    if (name == "ROTATION") rotation_.emplace(accessor);
    if (name == "SCALE") scale_.emplace(accessor);
  }
}

Affine InstanceStream::next() {
  if (!instanced_) return world_;
  Trs trs;
  if (translation_) translation_->read(std::span<double>(trs.translation));
  if (rotation_) rotation_->read(std::span<double>(trs.rotation));
  if (scale_) scale_->read(std::span<double>(trs.scale));
  check_rotation(trs, *path_);
  return compose(world_, trs.affine());
}

}  // namespace svdag
