// glTF 2.0 and GLB: streams the triangles of every drawn primitive in world space.
//
// Stream order: nodes depth first; within a node its primitives, of each its instances, of each the
// triangles. Only the positions of an indexed primitive are held (or joined: corners.h), and small
// primitives that nodes share; indices, unindexed positions and instances pass through small
// windows. Skins are not applied: a skinned mesh comes as stored, under its node's transform
// (only joints would place it, 3.7.3.2); nor are morph targets. Such triangles are counted as
// undeformed. Points and lines are skipped. A Draco primitive that also has plain data is read
// from the plain data, which is exact.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "io/scene/decoders/draco.h"
#include "io/scene/gltf/gltf_buffers.h"
#include "io/scene/gltf/gltf_corners.h"
#include "io/scene/gltf/gltf_document.h"
#include "io/scene/gltf/gltf_elements.h"
#include "io/scene/gltf/gltf_images.h"
#include "io/scene/gltf/gltf_kept.h"
#include "io/scene/gltf/gltf_nodes.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {
namespace {

class GltfReader {
 public:
  GltfReader(const File& file, const ReadOptions& options, const TriangleSink& sink)
      : document_(load_gltf(file, options.budget, options.images != nullptr)),
        options_(options),
        buffers_(document_, options.budget, options.spill, options.sandbox),
        kept_(options.budget),
        out_(sink) {}

  void read() {
    visit_nodes(document_, options_,
                [this](const JsonObject& node, const std::string& name, const Affine& world,
                       bool included) { read_node(node, name, world, included); });
    out_.flush();
  }

 private:
  void read_node(const JsonObject& node, const std::string& name, const Affine& world,
                 bool included) {
    const JsonObject mesh = document_.element("meshes", node.count("mesh"));
    out_.mesh(name, node.has("skin") || has_weights(node.has("weights") ? node : mesh));
    for (const auto& value : mesh.array("primitives")) {
      const JsonObject primitive(value, document_.file->path());
      const uint64_t mode = primitive.count("mode", kTriangles);
      if (mode > kTriangleFan) fail_input(primitive.path(), "has a primitive of unknown mode");
      const JsonObject attributes = primitive.object("attributes");
      if (mode < kTriangles || !attributes.has("POSITION")) continue;
      const std::string material = material_of(primitive);
      if (!wants_material(material, included)) continue;
      out_.material(material, colour_of(primitive));
      InstanceStream instances(node, world, &buffers_);
      if (const KeptPrimitive* kept = kept_.find(value)) {
        draw(*kept, mode, std::move(instances));
      } else {
        read_primitive(value, primitive, mode, std::move(instances));
      }
    }
  }

  // "" without a material, or if it has no name.
  std::string material_of(const JsonObject& primitive) const {
    if (!primitive.has("material")) return "";
    const uint64_t index = primitive.count("material");
    // Materials are not needed: a scene may lack them.
    if (index >= document_.root().array("materials").size()) return "";
    return document_.element("materials", index).text("name");
  }

  // The base colour of the material, times the mean of its texture.
  std::optional<Colour> colour_of(const JsonObject& primitive) {
    if (options_.images == nullptr || !primitive.has("material")) return {};
    const uint64_t index = primitive.count("material");
    if (index >= document_.root().array("materials").size()) return {};
    const JsonObject material = document_.element("materials", index);
    if (!material.has("pbrMetallicRoughness")) return {};
    const JsonObject pbr = material.object("pbrMetallicRoughness");
    std::optional<ImageMean> mean;
    if (pbr.has("baseColorTexture"))
      mean = mean_of_texture(document_, pbr.object("baseColorTexture"), &buffers_, options_.images);
    std::array<double, 4> factor{1, 1, 1, 1};
    if (!pbr.numbers("baseColorFactor", factor) && !mean) return {};
    const std::string& alpha = material.text("alphaMode");  // absent: OPAQUE, which ignores alpha
    const bool opaque = alpha.empty() || alpha == "OPAQUE";
    const LinearColour texels = !mean ? LinearColour() : opaque ? mean->all : mean->visible;
    return texels.times({factor[0], factor[1], factor[2]});
  }

  // `included`: whether the node is.
  bool wants_material(const std::string& material, bool included) const {
    if (material.empty()) return included;
    const bool matched = options_.names->includes(PartKind::kMaterial, material);
    return !options_.names->excludes(PartKind::kMaterial, material) && (included || matched);
  }

  // The next instance's transform; triangles from here on are seen through it.
  Affine place_next(InstanceStream* instances) {
    const Affine to_world = instances->next();
    out_.mirrored(is_mirror(to_world));
    return to_world;
  }

  // Whether morph targets affect the mesh: a node's weights override those of its mesh.
  static bool has_weights(const JsonObject& object) {
    const auto weights = object.array("weights");
    return std::any_of(weights.begin(), weights.end(),
                       [](const nlohmann::json& weight) { return weight != 0; });
  }

  void draw(const KeptPrimitive& kept, uint64_t mode, InstanceStream instances) {
    const auto placed = placed_.resize(kept.points.size(), options_.budget);
    for_each_placed(kept.points, placed, std::move(instances), [&](double) {
      KeptCorners corners(kept.indices, placed, document_.file->path());
      assemble(mode, kept.indices.size(), corners, out_);
    });
  }

  // Outside of Draco's data.
  bool has_data(uint64_t accessor) const {
    return document_.element("accessors", accessor).has("bufferView");
  }

  // `key`: the JSON value behind `primitive`.
  void read_primitive(const nlohmann::json& key, const JsonObject& primitive, uint64_t mode,
                      InstanceStream instances) {
    const uint64_t index = primitive.object("attributes").count("POSITION");
    const bool plain =
        has_data(index) && (!primitive.has("indices") || has_data(primitive.count("indices")));
    if (const auto draco = primitive.extension("KHR_draco_mesh_compression"); draco && !plain) {
      return read_draco_primitive(*draco, index, std::move(instances));
    }
    const Accessor positions = buffers_.accessor(index, "VEC3");
    if (positions.base.type == ComponentType::kUnsignedInt) {
      fail_input(primitive.path(), "has positions of a component type that glTF does not allow");
    }
    if (!primitive.has("indices")) {
      check_count(mode, positions.count());
      for (uint64_t i = 0; i < instances.count(); ++i) {
        SoupCorners corners(positions, place_next(&instances));
        assemble(mode, positions.count(), corners, out_);
      }
      return;
    }
    const Accessor indices = buffers_.accessor(primitive.count("indices"), "SCALAR");
    check_indices(indices);
    check_count(mode, indices.count());
    if (const KeptPrimitive* kept = kept_.meet(key, positions, indices)) {
      return draw(*kept, mode, std::move(instances));
    }
    if (!make_room(positions.count(), instances.count()))
      return join_primitive(positions, indices, mode, std::move(instances));
    std::span<Point> points = local_.resize(positions.count(), options_.budget);
    ElementStream(positions).read(as_numbers(points));
    const auto placed = place_for(points, instances);
    for_each_placed(points, placed, std::move(instances), [&](double) {
      IndexedCorners corners(indices, placed);
      assemble(mode, indices.count(), corners, out_);
    });
  }

  // Whether the points fit in memory, reusing the memory of earlier ones if necessary.
  bool make_room(uint64_t points, uint64_t instances) {
    if (options_.spill == nullptr) return true;
    const uint64_t copies = instances > 1 ? 2 : 1, share = options_.spill->share;
    const bool fits = points <= share / (copies * sizeof(Point));
    if (!fits || points * copies * sizeof(Point) > share - local_.bytes() - placed_.bytes()) {
      local_.release();
      placed_.release();
    }
    return fits;
  }

  // Positions that do not fit in memory as points of the world, and perhaps not at all.
  void join_primitive(const Accessor& accessor, const Accessor& indices, uint64_t mode,
                      InstanceStream instances) {
    const bool single = accessor.base.type == ComponentType::kFloat;
    Positions positions(options_,
                        single ? Positions::Precision::kSingle : Positions::Precision::kDouble,
                        accessor.count());
    ElementStream stream(accessor);
    std::array<Point, 1024> window;
    while (const size_t n = stream.read(as_numbers(window)))
      std::for_each_n(window.begin(), n, [&](const Point& p) { positions.add(p); });
    const auto draw_at = [&](auto& points, const Affine& to_world, BatchWriter& out) {
      IndexedCorners corners(indices, PlacedPoints(&points, to_world));
      assemble(mode, indices.count(), corners, out);
    };
    if (positions.spilled())
      record_corners(&positions, positions.size(),
                     [&](auto& recorder, auto& out) { draw_at(recorder, {}, out); });
    for (uint64_t i = 0; i < instances.count(); ++i) {
      const Affine to_world = place_next(&instances);
      if (positions.spilled()) {
        CornerReplayer replayer(&positions, positions.size());
        draw_at(replayer, to_world, out_);
      } else {
        draw_at(positions, to_world, out_);
      }
    }
  }

  void read_draco_primitive(const JsonObject& draco, uint64_t accessor, InstanceStream instances) {
    MemoryBudget::Reservation memory;
    const auto bytes = buffers_.view_bytes(draco.count("bufferView"), &memory);
    const DracoSource source{bytes, draco.path(), draco.object("attributes").count("POSITION"),
                             document_.element("accessors", accessor).flag("normalized"),
                             options_.sandbox};
    DracoMesh mesh = decode_draco(source, options_.budget);
    const std::vector<uint32_t>& indices = mesh.indices;
    const auto placed = place_for(mesh.positions, instances);
    for_each_placed(mesh.positions, placed, std::move(instances), [&](double stretch) {
      out_.quantisation(mesh.step * stretch);
      for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        out_.add(placed[indices[i]], placed[indices[i + 1]], placed[indices[i + 2]]);
      }
    });
    out_.quantisation(0);
  }

  // Where the instances of `points` are placed: a second copy only if there are several.
  std::span<Point> place_for(std::span<Point> points, const InstanceStream& instances) {
    return instances.count() > 1 ? placed_.resize(points.size(), options_.budget) : points;
  }

  // Brings `points` into world space at `placed` for every instance, and calls use(axis_stretch of
  // the transform).
  template <class Use>
  void for_each_placed(std::span<const Point> points, std::span<Point> placed,
                       InstanceStream instances, const Use& use) {
    for (uint64_t i = 0; i < instances.count(); ++i) {
      const Affine to_world = place_next(&instances);
      for (size_t v = 0; v < points.size(); ++v) placed[v] = to_world(points[v]);
      use(axis_stretch(to_world));
    }
  }

  void check_indices(const Accessor& indices) const {
    const ComponentType type = indices.base.type;
    const bool whole = type == ComponentType::kUnsignedByte ||
                       type == ComponentType::kUnsignedShort || type == ComponentType::kUnsignedInt;
    if (!whole) fail_input(*indices.path, "has vertex indices that are not unsigned integers");
  }

  void check_count(uint64_t mode, uint64_t corners) const {
    if (mode != kTriangles || corners % 3 == 0) return;
    fail_input(document_.file->path(), "has a triangle list of " + std::to_string(corners) +
                                           " corners, not a multiple of three");
  }

  GltfDocument document_;
  const ReadOptions& options_;
  GltfBuffers buffers_;
  KeptPrimitives kept_;
  PointArray local_, placed_;
  BatchWriter out_;
};

}  // namespace

void read_gltf(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  GltfReader(file, options, sink).read();
}

}  // namespace svdag
