#include "io/scene/gltf/gltf_pose.h"

#include <algorithm>
#include <array>

#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/gltf/gltf_nodes.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kPoseWindow = 256;  // vertices

void require_count(const Accessor& accessor, uint64_t vertices) {
  if (accessor.count() != vertices)
    fail_input(*accessor.path,
               "has a mesh whose vertex attributes differ in their number of elements");
}

}  // namespace

// A morph target: what it adds to each position.
class MorphStream {
 public:
  MorphStream(const Accessor& moves, double weight) : stream_(moves), weight_(weight) {}

  void add_to(std::span<Point> points) {
    stream_.read(as_numbers(std::span(window_).first(points.size())));
    for (size_t i = 0; i < points.size(); ++i) {
      for (int a = 0; a < 3; ++a) points[i][a] = points[i][a] + weight_ * window_[i][a];
    }
  }

 private:
  ElementStream stream_;
  double weight_;
  std::array<Point, kPoseWindow> window_;
};

// A set of four joints and weights of each vertex.
class JointStream {
 public:
  JointStream(const Accessor& joints, const Accessor& weights)
      : joints_(joints), weights_(weights), path_(*joints.path) {}

  // Adds wi * Mi(p) to `sums` and wi to `totals`.
  void add_to(std::span<const Point> points, const std::vector<Affine>& matrices,
              std::span<Point> sums, std::span<double> totals) {
    joints_.read(std::span<uint32_t>(joint_).first(4 * points.size()));
    weights_.read(std::span<double>(weight_).first(4 * points.size()));
    for (size_t i = 0; i < points.size(); ++i) {
      for (size_t k = 4 * i; k < 4 * i + 4; ++k) {
        const double weight = weight_[k];
        if (weight == 0) continue;  // its joint may be any number
        if (joint_[k] >= matrices.size())
          fail_input(path_, "has a vertex of joint " + std::to_string(joint_[k]) +
                                " in a skin of only " + std::to_string(matrices.size()));
        const Point moved = matrices[joint_[k]](points[i]);
        for (int a = 0; a < 3; ++a) sums[i][a] = sums[i][a] + weight * moved[a];
        totals[i] = totals[i] + weight;
      }
    }
  }

 private:
  ElementStream joints_, weights_;
  const std::string& path_;
  std::array<uint32_t, 4 * kPoseWindow> joint_;
  std::array<double, 4 * kPoseWindow> weight_;
};

bool GltfPose::is_skinned(const JsonObject& node, const JsonObject& primitive) {
  return node.has("skin") && primitive.object("attributes").has("JOINTS_0");
}

// The weights of morph targets: a node's override those of its mesh.
std::vector<double> GltfPose::weights_of(const JsonObject& node) const {
  const JsonObject mesh = document_.element("meshes", node.whole_number("mesh"));
  const JsonObject& owner = node.has("weights") ? node : mesh;
  std::vector<double> weights(owner.array("weights").size());
  if (!weights.empty()) owner.numbers("weights", weights);
  return weights;
}

bool GltfPose::moves(const JsonObject& node, const JsonObject& primitive) const {
  if (is_skinned(node, primitive)) return true;
  if (!primitive.has("targets")) return false;
  const std::vector<double> weights = weights_of(node);
  return std::ranges::any_of(weights, [](double weight) { return weight != 0; });
}

std::vector<MorphStream> GltfPose::morphs_of(const JsonObject& node, const JsonObject& primitive,
                                             uint64_t vertices, MemoryBudget::Reservation* memory) {
  std::vector<MorphStream> morphs;
  if (!primitive.has("targets")) return morphs;
  const std::vector<double> weights = weights_of(node);
  const auto targets = primitive.array("targets");
  for (size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
    const JsonObject target(targets[i], primitive.path());
    if (weights[i] == 0 || !target.has("POSITION")) continue;
    const Accessor moves = buffers_.accessor(target.whole_number("POSITION"), "VEC3");
    require_count(moves, vertices);
    memory->resize(memory->bytes() + sizeof(MorphStream) + ElementStream::kWindow, kPurpose);
    morphs.emplace_back(moves, weights[i]);
  }
  return morphs;
}

std::vector<JointStream> GltfPose::joints_of(const JsonObject& primitive, uint64_t vertices) {
  std::vector<JointStream> sets;
  const JsonObject attributes = primitive.object("attributes");
  for (int set = 0;; ++set) {
    const std::string joints = "JOINTS_" + std::to_string(set);
    if (!attributes.has(joints.c_str())) return sets;
    const std::string weights = "WEIGHTS_" + std::to_string(set);
    const Accessor numbers = buffers_.accessor(attributes.whole_number(joints.c_str()), "VEC4");
    const Accessor shares = buffers_.accessor(attributes.whole_number(weights.c_str()), "VEC4");
    require_count(numbers, vertices);
    require_count(shares, vertices);
    const ComponentType type = numbers.base.type;
    if (type != ComponentType::kUnsignedByte && type != ComponentType::kUnsignedShort)
      fail_input(primitive.path(), "has joints of a component type that glTF does not allow");
    sets.emplace_back(numbers, shares);
  }
}

void GltfPose::place(const Affine& place) {
  if (place == place_) return;
  place_ = place;
  worlds_.clear();
  skin_index_.reset();
  skin_ = {};
  memory_.resize(parents_.size() * sizeof(uint32_t), kPurpose);
}

Affine GltfPose::world_of(uint64_t node) {
  if (parents_.empty()) {
    const auto nodes = document_.root().array("nodes");
    memory_.resize(memory_.bytes() + nodes.size() * sizeof(uint32_t), kPurpose);
    parents_.resize(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
      const JsonObject parent(nodes[i], document_.file->path());
      for (const auto& child : parent.array("children")) {
        const uint64_t c = parent.index(child, "children");
        if (c < nodes.size()) parents_[size_t(c)] = uint32_t(i + 1);
      }
    }
  }
  std::vector<uint64_t> chain;  // from the node up to what is known
  for (uint64_t at = node;;) {
    if (worlds_.contains(at)) break;
    chain.push_back(at);
    if (chain.size() > kMaxNodeDepth)
      fail_input(document_.file->path(), "has a joint nodes[" + std::to_string(node) +
                                             "], which is too deep in the hierarchy");
    if (at >= parents_.size() || parents_[size_t(at)] == 0) break;
    at = parents_[size_t(at)] - 1;
  }
  memory_.resize(memory_.bytes() + chain.size() * (sizeof(Affine) + 64), kPurpose);
  for (size_t i = chain.size(); i-- > 0;) {
    const JsonObject object = document_.element("nodes", chain[i]);
    const uint32_t parent = parents_[size_t(chain[i])];
    worlds_[chain[i]] =
        compose(parent == 0 ? place_ : worlds_.at(parent - 1), local_transform(object));
  }
  return worlds_.at(node);
}

const std::vector<Affine>& GltfPose::skin(uint64_t index) {
  if (skin_index_ == index) return skin_;
  const JsonObject object = document_.element("skins", index);
  const auto joints = object.array("joints");
  skin_index_.reset();
  skin_.clear();
  std::optional<ElementStream> inverse;
  if (object.has("inverseBindMatrices")) {
    const Accessor matrices = buffers_.accessor(object.whole_number("inverseBindMatrices"), "MAT4");
    if (matrices.count() < joints.size())
      fail_input(object.path(), "has a skin of " + std::to_string(joints.size()) +
                                    " joints with only " + std::to_string(matrices.count()) +
                                    " inverse bind matrices");
    inverse.emplace(matrices);
  }
  if (joints.size() > skin_.capacity())
    memory_.resize(memory_.bytes() + (joints.size() - skin_.capacity()) * sizeof(Affine), kPurpose);
  skin_.reserve(joints.size());
  for (const auto& joint : joints) {
    Affine bind;
    std::array<double, 16> columns;
    if (inverse) {
      inverse->read(std::span<double>(columns));
      bind = affine_of_columns(columns, object.path());
    }
    skin_.push_back(compose(world_of(object.index(joint, "joints")), bind));
  }
  skin_index_ = index;
  return skin_;
}

void GltfPose::visit_vertices(const JsonObject& node, const JsonObject& primitive,
                              const Accessor& positions, const Affine& world,
                              const std::function<void(const Point&)>& visit) {
  MemoryBudget::Reservation memory = budget_.reserve(0, kPurpose);
  std::vector<MorphStream> morphs = morphs_of(node, primitive, positions.count(), &memory);
  const bool skinned = is_skinned(node, primitive);
  std::vector<JointStream> sets;
  const std::vector<Affine>* matrices = nullptr;
  if (skinned) {
    sets = joints_of(primitive, positions.count());
    matrices = &skin(node.whole_number("skin"));
  }
  ElementStream stream(positions);
  std::array<Point, kPoseWindow> window;
  while (const size_t n = stream.read(as_numbers(window))) {
    const std::span<Point> points = std::span(window).first(n);
    for (MorphStream& morph : morphs) morph.add_to(points);
    if (!skinned) {
      std::ranges::for_each(points, visit);
      continue;
    }
    std::array<Point, kPoseWindow> sums;
    std::array<double, kPoseWindow> totals{};
    sums.fill(Point(0));
    for (JointStream& set : sets)
      set.add_to(points, *matrices, std::span(sums).first(n), std::span(totals).first(n));
    for (size_t i = 0; i < n; ++i) {
      const bool weighted = totals[i] > 0;
      unweighted_ += !weighted;
      Point v = world(points[i]);
      for (int a = 0; weighted && a < 3; ++a) v[a] = sums[i][a] / totals[i];
      visit(v);
    }
  }
}

}  // namespace svdag
