// Reads FBX, of all versions, binary and text, with ufbx.
//
// ufbx holds the whole scene in doubles and computes the transforms of nodes: pivots, pre- and
// post-rotation, rotation orders, inherit modes, and geometric transforms, which move the mesh of
// their node only. It parses untrusted bytes, so it runs in a limited child; it is compiled without
// stdio and cannot open other files.
//
// The three axes of the file are turned to x right, y up, z front; a left-handed file is a mirror
// image. Coordinates keep the unit of the file. Animation is not evaluated.
//
// If the colours of points are wanted: a texture replaces the colour of its material, as a
// connected property does in FBX, and is multiplied by the first set of colours of vertices, which
// are sRGB. Only textures in the file are read. Rejected: files beside it; all programs that hash
// the inputs would have to decode the scene to learn their names.
#include <ufbx.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/affine.h"
#include "io/scene/readers/named_mesh.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint32_t kMaxFbxDepth = 512;  // of nodes; the walk recurses

std::string text_of(const ufbx_string& text) {
  return std::string(text.data, text.length);
}

Affine affine_of(const ufbx_matrix& m) {
  Affine affine;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) affine.m[r][c] = m.cols[c].v[r];
  }
  return affine;
}

// The rotation, or mirror image, that turns the axes of the file to x, y and z. A file that names
// its vertical axis only is rotated by that.
Affine turned_axes(const ufbx_coordinate_axes& axes) {
  if (ufbx_coordinate_axes_valid(axes)) {
    Affine turned{};
    const ufbx_coordinate_axis rows[3] = {axes.right, axes.up, axes.front};
    for (int r = 0; r < 3; ++r) {
      turned.m[r] = {};
      turned.m[r][size_t(rows[r]) / 2] = rows[r] % 2 == 0 ? 1 : -1;
    }
    return turned;
  }
  if (axes.up >= UFBX_COORDINATE_AXIS_UNKNOWN) return {};
  constexpr const char* kNames[] = {"x", "-x", "y", "-y", "z", "-z"};
  return parse_up(kNames[axes.up]);
}

const ufbx_material_map& base_of(const ufbx_material& material) {
  return material.features.pbr.enabled ? material.pbr.base_color : material.fbx.diffuse_color;
}

// The base or diffuse colour, which is sRGB.
std::optional<Colour> colour_of(const ufbx_material& material) {
  const bool is_pbr = material.features.pbr.enabled;
  const ufbx_material_map& colour = base_of(material);
  const ufbx_material_map& factor = is_pbr ? material.pbr.base_factor : material.fbx.diffuse_factor;
  if (!colour.has_value) return {};
  const double scale = factor.has_value ? factor.value_real : 1;
  const ufbx_vec3 c = colour.value_vec3;
  return Colour{colour_code(scale * c.x), colour_code(scale * c.y), colour_code(scale * c.z)};
}

// Where the corners of a mesh are in the texture of a material, and their colours; null: nowhere.
struct FbxSurface {
  const ufbx_texture* texture = nullptr;
  const ufbx_vertex_vec2* place = nullptr;
  const ufbx_vertex_vec4* colour = nullptr;

  bool empty() const { return texture == nullptr && colour == nullptr; }
  PaintedCorner corner(size_t i) const {
    PaintedCorner corner;
    if (texture != nullptr) {
      const ufbx_vec2 uv = ufbx_get_vertex_vec2(place, i);
      Point p(uv.x, uv.y, 0);
      if (texture->has_uv_transform) p = affine_of(texture->uv_to_texture)(p);
      corner.u = p.x;
      corner.v = 1 - p.y;
    }
    if (colour != nullptr) {
      const ufbx_vec4 c = ufbx_get_vertex_vec4(colour, i);
      corner.colour = {light16_of_srgb(c.x), light16_of_srgb(c.y), light16_of_srgb(c.z)};
    }
    return corner;
  }
};

FbxSurface surface_of(const ufbx_mesh& mesh, const ufbx_material* material) {
  FbxSurface surface;
  if (mesh.vertex_color.exists) surface.colour = &mesh.vertex_color;
  const ufbx_texture* texture = material != nullptr ? base_of(*material).texture : nullptr;
  if (texture == nullptr || texture->file_textures.count == 0) return surface;
  texture = texture->file_textures.data[0];  // of layers the lowest
  if (!texture->has_file || !mesh.vertex_uv.exists) return surface;
  surface.texture = texture;
  surface.place = &mesh.vertex_uv;
  for (const ufbx_uv_set& set : mesh.uv_sets) {
    if (text_of(set.name) == text_of(surface.texture->uv_set)) surface.place = &set.vertex_uv;
  }
  return surface;
}

Wrap wrap_of(ufbx_wrap_mode mode) {
  return mode == UFBX_WRAP_CLAMP ? Wrap::kClamp : Wrap::kRepeat;
}

struct FbxOptions {
  bool hidden = false;   // also hidden nodes
  bool painted = false;  // with the colours of points
};

// Sends the meshes of a scene, node by node.
class FbxSender {
 public:
  FbxSender(const ufbx_scene& scene, const FbxOptions& options, const std::string& path,
            NamedMeshSender* out)
      : axes_(turned_axes(scene.settings.axes)),
        options_(options),
        path_(path),
        out_(*out),
        files_(scene.texture_files) {}

  void send(const ufbx_scene& scene) {
    if (scene.settings.unit_meters > 0) out_.unit(scene.settings.unit_meters);
    send_node(*scene.root_node, {}, true);
    out_.left_out(left_out_);
  }

 private:
  void send_node(const ufbx_node& node, const std::string& parent_names, bool parent_is_visible) {
    const bool inherits = ufbx_find_int(&node.props, "VisibilityInheritance", 1) != 0;
    const bool is_visible = node.visible && (parent_is_visible || !inherits);
    std::string names = parent_names;
    if (!node.is_root) names += (names.empty() ? "" : std::string(1, '\0')) + text_of(node.name);
    if (is_visible || options_.hidden) {
      for (ufbx_element* attribute : node.all_attribs) send_attribute(node, *attribute, names);
    } else if (node.mesh != nullptr) {
      left_out_.add(Omission::kHidden);
    }
    for (const ufbx_node* child : node.children) send_node(*child, names, is_visible);
  }

  void send_attribute(const ufbx_node& node, const ufbx_element& attribute,
                      const std::string& names) {
    switch (attribute.type) {
      case UFBX_ELEMENT_MESH:
        send_mesh(node, *ufbx_as_mesh(&attribute), names);
        break;
      case UFBX_ELEMENT_LINE_CURVE:
        left_out_.add(Omission::kPointsOrLines);
        break;
      case UFBX_ELEMENT_NURBS_CURVE:
      case UFBX_ELEMENT_NURBS_SURFACE:
      case UFBX_ELEMENT_NURBS_TRIM_SURFACE:
        left_out_.add(Omission::kFreeForm);
        break;
      case UFBX_ELEMENT_PROCEDURAL_GEOMETRY:
        left_out_.add(Omission::kUnread);
        break;
      default:
        break;  // lights, cameras, bones
    }
  }

  void send_mesh(const ufbx_node& node, const ufbx_mesh& mesh, const std::string& names) {
    LeftOut left_out;
    const bool is_undeformed = mesh.skin_deformers.count > 0 || mesh.blend_deformers.count > 0 ||
                               mesh.cache_deformers.count > 0;
    if (mesh.vertex_color.exists && !options_.painted) left_out.add(Omission::kVertexColours);
    const Affine to_world = compose(axes_, affine_of(node.geometry_to_world));
    out_.begin({left_out, mesh.num_vertices, is_mirror(to_world), is_undeformed}, names);
    for (const ufbx_vec3& p : mesh.vertices) out_.vertex(to_world({p.x, p.y, p.z}));
    const ufbx_material_list& materials =
        node.materials.count > 0 ? node.materials : mesh.materials;
    for (const ufbx_mesh_part& part : mesh.material_parts) {
      if (part.num_faces == 0) continue;
      const ufbx_material* material =
          part.index < materials.count ? materials.data[part.index] : nullptr;
      const FbxSurface surface = options_.painted ? surface_of(mesh, material) : FbxSurface();
      if (material == nullptr) {
        out_.material("", {});
      } else if (base_of(*material).texture != nullptr && !options_.painted) {
        out_.material(text_of(material->name), {});  // a factor without the mean is meaningless
      } else {
        out_.material(text_of(material->name), colour_of(*material));
      }
      if (!surface.empty()) send_paint(surface);
      for (const uint32_t face : part.face_indices) send_face(mesh, mesh.faces.data[face], surface);
    }
    out_.end();
  }

  void send_paint(const FbxSurface& surface) {
    NamedPaint paint;
    if (const ufbx_texture* texture = surface.texture) {
      const auto [sent, is_new] =
          images_.try_emplace(texture->file_index, uint32_t(images_.size() + 1));
      if (is_new) {
        const ufbx_texture_file& file = files_.data[texture->file_index];
        out_.image(text_of(file.relative_filename),
                   {static_cast<const std::byte*>(file.content.data), file.content.size});
      }
      paint.image = sent->second;
      paint.wrap_u = wrap_of(texture->wrap_u);
      paint.wrap_v = wrap_of(texture->wrap_v);
    }
    out_.paint(paint);
  }

  void send_face(const ufbx_mesh& mesh, const ufbx_face& face, const FbxSurface& surface) {
    const std::span corners(mesh.vertex_indices.data + face.index_begin, face.num_indices);
    for (const uint32_t corner : corners) {
      if (corner >= mesh.num_vertices)
        fail_input(path_, "has a face with a corner that does not exist");
    }
    painted_.clear();
    for (size_t i = 0; i < corners.size() && !surface.empty(); ++i)
      painted_.push_back(surface.corner(face.index_begin + i));
    if (!corners.empty()) out_.polygon(corners, painted_);
  }

  const Affine axes_;
  const FbxOptions options_;
  const std::string& path_;
  NamedMeshSender& out_;
  const ufbx_texture_file_list& files_;
  std::map<uint32_t, uint32_t> images_;  // that were sent: their numbers by index of files_
  std::vector<PaintedCorner> painted_;   // of the current face
  LeftOut left_out_;
};

// ufbx takes the end of the file for the end of all blocks, so that a text that is cut off would
// lose nodes silently. Binary files state their lengths.
void check_blocks_end(std::span<const std::byte> bytes, const std::string& path) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("Kaydara FBX Binary")) return;
  int64_t open = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == ';') {  // a string, or a comment
      i = text.find(text[i] == '"' ? '"' : '\n', i + 1);
      if (i == text.npos) break;
    } else if (text[i] == '{') {
      ++open;
    } else if (text[i] == '}') {
      --open;
    }
  }
  if (open > 0)
    fail_input(path, "is not a valid FBX file: it ends too early, " + std::to_string(open) +
                         " blocks have no end");
}

void decode_fbx(std::span<const std::byte> bytes, const std::string& path, const FbxOptions& wanted,
                NamedMeshSender* out) {
  check_blocks_end(bytes, path);
  ufbx_load_opts options = {};
  options.file_format = UFBX_FILE_FORMAT_FBX;
  options.ignore_animation = true;
  options.ignore_embedded = !wanted.painted;
  options.skip_skin_vertices = true;
  options.node_depth_limit = kMaxFbxDepth;
  // Indices of normals and the like may be broken; those of corners are checked.
  options.index_error_handling = UFBX_INDEX_ERROR_HANDLING_NO_INDEX;
  ufbx_error error;
  const ufbx_scene* scene = ufbx_load_memory(bytes.data(), bytes.size(), &options, &error);
  if (scene == nullptr) {
    if (error.type == UFBX_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    fail_input(path, "is not a valid FBX file: " + text_of(error.description));
  }
  for (const ufbx_warning& warning : scene->metadata.warnings) {
    if (warning.type == UFBX_WARNING_TRUNCATED_ARRAY)
      fail_input(path, "is not a valid FBX file: " + text_of(warning.description));
  }
  FbxSender(*scene, wanted, path, out).send(*scene);  // the child exits: the scene is not freed
}

}  // namespace

LeftOut read_fbx(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_named_meshes(
      file, "FBX", options, out,
      [&](std::span<const std::byte> bytes, const std::string& path, NamedMeshSender* sender) {
        decode_fbx(bytes, path, {options.hidden, options.paints != nullptr}, sender);
      });
}

}  // namespace svdag
