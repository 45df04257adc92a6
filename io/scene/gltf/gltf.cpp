// glTF 2.0 and GLB: streams the triangles of every drawn primitive in world space.
//
// Stream order: nodes depth first; within a node its primitives, of each its instances, of each the
// triangles. Only the positions of an indexed primitive are held (mesh_writer.h), and small
// primitives that nodes share; indices, unindexed positions and instances pass through small
// windows. Animations are applied at a time (gltf_animation.h), skins and morph targets
// (gltf_pose.h), except to Draco primitives, whose triangles are counted as undeformed. Points and
// lines are skipped. A Draco primitive that also has plain data is read from the plain data, which
// is exact.
#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/gltf_document.h"
#include "io/scene/gltf/document/gltf_elements.h"
#include "io/scene/gltf/document/tile.h"
#include "io/scene/gltf/gltf_animation.h"
#include "io/scene/gltf/gltf_assembly.h"
#include "io/scene/gltf/gltf_cut_out.h"
#include "io/scene/gltf/gltf_draco.h"
#include "io/scene/gltf/gltf_images.h"
#include "io/scene/gltf/gltf_kept.h"
#include "io/scene/gltf/gltf_mean_colours.h"
#include "io/scene/gltf/gltf_nodes.h"
#include "io/scene/gltf/gltf_paint.h"
#include "io/scene/gltf/gltf_pose.h"
#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"

namespace svdag {
namespace {

class GltfReader {
 public:
  GltfReader(const File& file, const ReadOptions& options, MeshWriter* out)
      : tile_(file, options.budget),
        document_(load(options)),
        options_(options),
        buffers_(document_, options.budget, options.spill, options.sandbox),
        draco_(document_, &buffers_, options),
        kept_(options.budget),
        pose_(document_, &buffers_, options.budget),
        mean_colours_(document_, &buffers_),
        out_(*out) {
    if (options.time != nullptr)
      left_out_.add(Omission::kChannels, pose_at(*options.time, &document_, &buffers_));
  }

  LeftOut read() {
    for (uint64_t i = 0; i < tile_.instances(); ++i) {
      const Affine place = compose(tile_.placement(i), centre());
      pose_.place(place);
      const uint64_t hidden =
          visit_nodes(document_, options_, place,
                      [this](const JsonObject& node, const std::string& name, const Affine& world,
                             bool included) { read_node(node, name, world, included); });
      left_out_.add(Omission::kHidden, hidden);
    }
    left_out_.add(Omission::kUnweighted, pose_.unweighted());
    return left_out_;
  }

 private:
  GltfDocument load(const ReadOptions& options) const {
    const GltfParts parts{options.images != nullptr, options.time != nullptr};
    return load_with_cut_outs(tile_.gltf_file(), options.budget, parts, tile_.gltf_bytes(),
                              options.alpha != nullptr ? options.names : nullptr);
  }

  // CESIUM_RTC: the origin of a scene on the globe, given z-up.
  Affine centre() const {
    Affine move;
    const auto extension = document_.root().extension("CESIUM_RTC");
    std::array<double, 3> at{0, 0, 0};
    if (extension) extension->numbers("center", at);
    move.m[0][3] = at[0];
    move.m[1][3] = at[2];
    move.m[2][3] = -at[1];
    return move;
  }

  void read_node(const JsonObject& node, const std::string& name, const Affine& world,
                 bool included) {
    const JsonObject mesh = document_.element("meshes", node.whole_number("mesh"));
    out_.mesh(name, is_left_undeformed(node, mesh));
    for (const auto& value : mesh.array("primitives")) {
      const JsonObject primitive(value, document_.file->path());
      const uint64_t mode = primitive.whole_number("mode", kTriangles);
      if (mode > kTriangleFan) fail_input(primitive.path(), "has a primitive of unknown mode");
      const JsonObject attributes = primitive.object("attributes");
      if (!attributes.has("POSITION")) continue;
      const auto material = material_of(primitive);
      const std::string name_of_material = material ? material->text("name") : "";
      if (!wants_material(name_of_material, included)) continue;
      if (mode < kTriangles) {
        left_out_.add(Omission::kPointsOrLines);
        continue;
      }
      const GltfCutOut* cut = cut_of(primitive, material);
      if (material && cut == nullptr) count_transparent(*material);
      if (cut != nullptr && draco_.attributes_of(primitive).has("COLOR_0") &&
          has_vertex_alpha(attribute_of(value, "COLOR_0", GltfBuffers::kAnyType)))
        left_out_.add(Omission::kVertexAlpha);
      if (cut != nullptr && cut->cut.is_opaque()) cut = nullptr;
      const GltfPaint* const paint = paint_of(primitive, material, cut);
      if (paint == nullptr && options_.images != nullptr && attributes.has("COLOR_0"))
        left_out_.add(Omission::kVertexColours);
      out_.material(name_of_material, colour_of(primitive, material));
      InstanceStream instances(node, world, &buffers_);
      if (cut != nullptr || paint != nullptr) {
        draw_textured(cut, paint, node, value, mode, world, &instances);
      } else if (pose_.moves(node, primitive) && !draco_.holds(primitive)) {
        draw_posed(node, primitive, mode, world, &instances);
      } else if (const KeptPrimitive* kept = kept_.find(value)) {
        draw_kept(*kept, mode, &instances);
      } else {
        read_primitive(value, primitive, mode, &instances);
      }
    }
  }

  // The material, which is not needed: a scene may lack it.
  std::optional<JsonObject> material_of(const JsonObject& primitive) const {
    if (!primitive.has("material")) return {};
    const uint64_t index = primitive.whole_number("material");
    if (index >= document_.root().array("materials").size()) return {};
    return document_.element("materials", index);
  }

  // What cuts the primitive's material; null: it is whole.
  const GltfCutOut* cut_of(const JsonObject& primitive, const std::optional<JsonObject>& material) {
    if (options_.alpha == nullptr || !material) return nullptr;
    const auto [at, is_new] = cuts_.try_emplace(primitive.whole_number("material"));
    auto& [cut, without_texture] = at->second;
    if (is_new && is_cut_out(*material, *options_.names)) {
      cut = cut_out_of(document_, *material, &buffers_, options_.alpha);
      without_texture = cut;
      without_texture->use.set.reset();
      without_texture->cut.image = options_.alpha->opaque();
    }
    if (!cut) return nullptr;
    const bool has_points = has_texture_points(cut->use, draco_.attributes_of(primitive));
    return has_points ? &*cut : &*without_texture;
  }

  // What colours the points of the primitive; null: it has one colour, or these are not wanted.
  const GltfPaint* paint_of(const JsonObject& primitive, const std::optional<JsonObject>& material,
                            const GltfCutOut* cut) {
    if (options_.paints == nullptr) return nullptr;
    const JsonObject attributes = draco_.attributes_of(primitive);
    const bool has_colours = attributes.has("COLOR_0");
    if (!material) return has_colours ? &white_ : nullptr;
    const uint64_t index = primitive.whole_number("material");
    const double threshold = cut != nullptr ? cut->cut.threshold : 0;
    auto found = paints_.find({index, threshold});
    if (found == paints_.end())
      found =
          paints_
              .emplace(std::pair(index, threshold),
                       svdag::paint_of(document_, *material, threshold, &buffers_, options_.paints))
              .first;
    const GltfPaint& textured = found->second;
    if (has_texture_points(textured.use, attributes)) return &textured;
    if (!has_colours) return nullptr;
    auto plain = plain_paints_.find(index);
    if (plain == plain_paints_.end()) {
      plain = plain_paints_.emplace(index, GltfPaint()).first;
      plain->second.paint.factor = textured.paint.factor;
    }
    return &plain->second;
  }

  // The one colour of a primitive, if it is wanted.
  std::optional<Colour> colour_of(const JsonObject& primitive,
                                  const std::optional<JsonObject>& material) {
    if (options_.images == nullptr || !material) return {};
    return options_.paints != nullptr
               ? factor_colour(*material)
               : mean_colours_.of(primitive.whole_number("material"), options_.images);
  }

  // Of a mesh that is baked whole.
  void count_transparent(const JsonObject& material) {
    const std::string& alpha = material.text("alphaMode");
    if (alpha == "BLEND" && options_.alpha != nullptr && has_base_texture(material)) {
      left_out_.add(Omission::kBlended);
    } else if (alpha == "MASK" || alpha == "BLEND") {
      left_out_.add(Omission::kCutOuts);
    }
  }

  // `included`: whether the node is.
  bool wants_material(const std::string& material, bool included) const {
    if (material.empty()) return included;
    const bool matched = options_.names->includes(PartKind::kMaterial, material);
    return !options_.names->excludes(PartKind::kMaterial, material) && (included || matched);
  }

  // Whether the mesh has a primitive that a skin or morph targets move, but which is read as
  // stored.
  bool is_left_undeformed(const JsonObject& node, const JsonObject& mesh) const {
    return std::ranges::any_of(mesh.array("primitives"), [&](const nlohmann::json& value) {
      const JsonObject primitive(value, document_.file->path());
      if (node.has("skin") && !GltfPose::is_skinned(node, primitive)) return true;
      return draco_.holds(primitive) && pose_.moves(node, primitive);
    });
  }

  // `key`: the JSON value behind `primitive`.
  void read_primitive(const nlohmann::json& key, const JsonObject& primitive, uint64_t mode,
                      InstanceStream* instances) {
    if (const DracoPrimitive* draco = draco_.find(key))
      return draw_indexed(draco->positions, draco->indices, kTriangles, draco->step, instances);
    const Accessor positions = positions_of(primitive);
    if (!primitive.has("indices")) return draw_soup(positions, mode, instances);
    const Accessor indices = indices_of(primitive, mode);
    if (const KeptPrimitive* kept = kept_.keep_repeated(key, positions, indices))
      return draw_kept(*kept, mode, instances);
    draw_indexed(positions, indices, mode, 0, instances);
  }

  Accessor positions_of(const JsonObject& primitive) {
    const Accessor positions =
        buffers_.accessor(primitive.object("attributes").whole_number("POSITION"), "VEC3");
    if (positions.base.type == ComponentType::kUnsignedInt)
      fail_input(primitive.path(), "has positions of a component type that glTF does not allow");
    return positions;
  }

  Accessor indices_of(const JsonObject& primitive, uint64_t mode) {
    const Accessor indices = buffers_.accessor(primitive.whole_number("indices"), "SCALAR");
    check_indices(indices);
    check_count(mode, indices.count());
    return indices;
  }

  auto add_vertex() {
    return [this](const Point& p) { out_.vertex(p); };
  }
  auto add_triangle() {
    return [this](uint32_t a, uint32_t b, uint32_t c) { out_.triangle(a, b, c); };
  }

  // Draws a primitive that a skin or morph targets move. Skinned, it is in the world, once.
  void draw_posed(const JsonObject& node, const JsonObject& primitive, uint64_t mode,
                  const Affine& world, InstanceStream* instances) {
    const Accessor positions = positions_of(primitive);
    const auto add_vertices = [&] {
      pose_.visit_vertices(node, primitive, positions, world, add_vertex());
    };
    const auto add_triangles = [&] {
      if (primitive.has("indices")) {
        const Accessor indices = indices_of(primitive, mode);
        IndexStream corners(indices, positions.count());
        return assemble(mode, indices.count(), corners, add_triangle());
      }
      check_count(mode, positions.count());
      uint64_t next = 0;
      auto corners = [&] { return next++; };
      assemble(mode, positions.count(), corners,
               [this](uint64_t a, uint64_t b, uint64_t c) { out_.triangle(a, b, c); });
    };
    InstanceStream once;
    draw(MeshWriter::Precision::kDouble, positions.count(), 0,
         GltfPose::is_skinned(node, primitive) ? &once : instances, add_vertices, add_triangles);
  }

  // An attribute that the primitive of the JSON value `key` has, compressed or not.
  Accessor attribute_of(const nlohmann::json& key, const std::string& name, const char* type) {
    if (const DracoPrimitive* const draco = draco_.find(key)) return draco->attributes.at(name);
    const JsonObject primitive(key, document_.file->path());
    return buffers_.accessor(primitive.object("attributes").whole_number(name.c_str()), type);
  }

  // Draws a primitive whose material is cut, or whose points have colours of their own: all of its
  // vertices are held. `cut` or `paint` may be null.
  void draw_textured(const GltfCutOut* cut, const GltfPaint* paint, const JsonObject& node,
                     const nlohmann::json& key, uint64_t mode, const Affine& world,
                     InstanceStream* instances) {
    const JsonObject primitive(key, document_.file->path());
    const DracoPrimitive* const draco = draco_.find(key);
    if (draco != nullptr) mode = kTriangles;
    const Accessor positions = draco != nullptr ? draco->positions : positions_of(primitive);
    const auto attribute = [&](const std::string& name, const char* type) {
      return attribute_of(key, name, type);
    };
    const uint64_t count = positions.count();
    const auto memory =
        options_.budget->reserve(count * sizeof(Point), "vertices of a textured mesh");
    MemoryBudget::Reservation texture_memory, colour_memory;
    const std::vector<TexturePoint> texture =
        texture_of(cut, paint, draco_.attributes_of(primitive), attribute, count, &texture_memory);
    std::vector<VertexColour> colours;
    if (paint != nullptr && draco_.attributes_of(primitive).has("COLOR_0"))
      colours = vertex_colours(attribute("COLOR_0", GltfBuffers::kAnyType), count, options_.budget,
                               &colour_memory, &left_out_);
    std::vector<Point> points;
    points.reserve(size_t(count));
    const auto add_point = [&](const Point& p) { points.push_back(p); };
    draco != nullptr ? visit_stored(positions, add_point)
                     : pose_.visit_vertices(node, primitive, positions, world, add_point);
    const bool is_posed = draco == nullptr && GltfPose::is_skinned(node, primitive);
    InstanceStream once;
    InstanceStream* const places = is_posed ? &once : instances;
    for (uint64_t i = 0; i < places->count(); ++i) {
      const Affine to_world = places->next();
      out_.begin_soup();
      out_.place(to_world, draco != nullptr ? draco->step : 0);
      out_.cut_out(cut != nullptr ? &cut->cut : nullptr);
      out_.paint(paint != nullptr ? &paint->paint : nullptr);
      const auto add = [&](uint64_t a, uint64_t b, uint64_t c) {
        const Triangle t{{to_world(points[a]), to_world(points[b]), to_world(points[c])}};
        const TextureCorners corners =
            texture.empty() ? TextureCorners() : TextureCorners{texture[a], texture[b], texture[c]};
        if (paint == nullptr) return out_.add_textured(t, corners);
        out_.add_textured(
            t, corners,
            colours.empty() ? kWhiteCorners : CornerColours{colours[a], colours[b], colours[c]});
      };
      if (draco != nullptr || primitive.has("indices")) {
        const Accessor indices = draco != nullptr ? draco->indices : indices_of(primitive, mode);
        IndexStream corners(indices, count);
        assemble(mode, indices.count(), corners, add);
      } else {
        check_count(mode, count);
        uint64_t next = 0;
        auto corners = [&] { return next++; };
        assemble(mode, count, corners, add);
      }
      out_.cut_out(nullptr);
      out_.paint(nullptr);
    }
  }

  // In the texture of `cut` and `paint`, which is one; empty without. `attribute`: returns the
  // accessor of an attribute, of the type.
  template <class Attribute>
  std::vector<TexturePoint> texture_of(const GltfCutOut* cut, const GltfPaint* paint,
                                       const JsonObject& attributes, const Attribute& attribute,
                                       uint64_t count, MemoryBudget::Reservation* memory) {
    const auto points_in = [&](const GltfTextureUse& use, const auto& image, bool anywhere) {
      return texture_points(use, image.width(), image.height(),
                            attribute(texture_attribute(use), "VEC2"), count, anywhere,
                            options_.budget, memory);
    };
    if (cut != nullptr && has_texture_points(cut->use, attributes))
      return points_in(cut->use, *cut->cut.image, false);
    if (paint == nullptr || !paint->paint.image) return {};
    return points_in(paint->use, *paint->paint.image, true);
  }

  template <class Visit>
  static void visit_stored(const Accessor& positions, const Visit& visit) {
    ElementStream stream(positions);
    std::array<Point, 1024> window;
    while (const size_t n = stream.read(as_numbers(window)))
      std::for_each_n(window.begin(), n, visit);
  }

  void draw_soup(const Accessor& positions, uint64_t mode, InstanceStream* instances) {
    check_count(mode, positions.count());
    out_.begin_soup();
    for (uint64_t i = 0; i < instances->count(); ++i) {
      const Affine to_world = instances->next();
      out_.place(to_world, 0);
      PointStream corners(positions, to_world);
      assemble(mode, positions.count(), corners,
               [&](const Point& a, const Point& b, const Point& c) { out_.add(a, b, c); });
    }
  }

  void draw_kept(const KeptPrimitive& kept, uint64_t mode, InstanceStream* instances) {
    draw(
        MeshWriter::Precision::kDouble, kept.points.size(), 0, instances,
        [&] { std::for_each(kept.points.begin(), kept.points.end(), add_vertex()); },
        [&] {
          IndexStream corners(kept.indices, kept.points.size(), document_.file->path());
          assemble(mode, kept.indices.size(), corners, add_triangle());
        });
  }

  void draw_indexed(const Accessor& positions, const Accessor& indices, uint64_t mode, double step,
                    InstanceStream* instances) {
    const bool single = positions.base.type == ComponentType::kFloat;
    draw(
        single ? MeshWriter::Precision::kSingle : MeshWriter::Precision::kDouble, positions.count(),
        step, instances, [&] { visit_stored(positions, add_vertex()); },
        [&] {
          IndexStream corners(indices, positions.count());
          assemble(mode, indices.count(), corners, add_triangle());
        });
  }

  // Draws every instance of a primitive whose vertices and triangles these functions pass on.
  template <class AddVertices, class AddTriangles>
  void draw(MeshWriter::Precision precision, uint64_t vertices, double step,
            InstanceStream* instances, const AddVertices& add_vertices,
            const AddTriangles& add_triangles) {
    for (uint64_t i = 0; i < instances->count(); ++i) {
      const Affine to_world = instances->next();
      if (i == 0) {
        out_.begin(precision, vertices, instances->count() == 1 ? &to_world : nullptr);
        add_vertices();
      }
      if (out_.place(to_world, step)) add_triangles();
    }
  }

  void check_indices(const Accessor& indices) const {
    const ComponentType type = indices.base.type;
    const bool whole = type == ComponentType::kUnsignedByte ||
                       type == ComponentType::kUnsignedShort || type == ComponentType::kUnsignedInt;
    if (!whole) fail_input(*indices.path, "has vertex indices that are not unsigned integers");
  }

  // Corners after the last whole triangle are not drawn (3.7.2.1).
  void check_count(uint64_t mode, uint64_t corners) {
    if (mode == kTriangles) left_out_.add(Omission::kCornersLeft, corners % 3);
  }

  Tile tile_;
  GltfDocument document_;
  const ReadOptions& options_;
  GltfBuffers buffers_;
  DracoPrimitives draco_;
  KeptPrimitives kept_;
  GltfPose pose_;
  std::map<std::pair<uint64_t, double>, GltfPaint> paints_;  // by material and threshold
  std::map<uint64_t, GltfPaint> plain_paints_;               // by material, without its texture
  GltfPaint white_;
  GltfMeanColours mean_colours_;
  // By material: with and without its texture; none: it is whole.
  std::map<uint64_t, std::array<std::optional<GltfCutOut>, 2>> cuts_;
  MeshWriter& out_;
  LeftOut left_out_;
};

}  // namespace

LeftOut read_gltf(const File& file, const ReadOptions& options, MeshWriter* out) {
  return GltfReader(file, options, out).read();
}

}  // namespace svdag
