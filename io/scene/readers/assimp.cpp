// Reads COLLADA and 3DS with Assimp.
//
// Assimp holds the whole scene, so these formats are not streamed. It parses untrusted bytes, so it
// runs in a limited child. Its positions are floats; the transforms of nodes are composed here, in
// double. Polygons are passed on as they are: Assimp's own triangulation may drop some. It turns
// the files so that y is up. COLLADA comes in metres, 3DS in the units of the file.
//
// The colour of a material is its base or diffuse colour, which is sRGB; its textures are not read.
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/affine.h"
#include "io/scene/readers/named_mesh.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr const char* kCollada = "dae";  // its ending
constexpr int kMaxNodeDepth = 512;  // of nodes; the walk recurses

Affine affine_of(const aiMatrix4x4& m) {
  Affine affine;
  for (unsigned r = 0; r < 3; ++r) {
    for (unsigned c = 0; c < 4; ++c) affine.m[r][c] = double(m[r][c]);
  }
  return affine;
}

// The base or diffuse colour. A material with a texture has no colour, since a factor without the
// mean is meaningless; nor has one with the grey that Assimp gives to materials of COLLADA and 3DS
// without a colour.
std::optional<Colour> colour_of(const aiMaterial& material) {
  constexpr float kAssimpsGrey = 0.6F;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (material.GetTextureCount(type) > 0) return {};
  }
  aiColor3D c;
  if (material.Get(AI_MATKEY_BASE_COLOR, c) != AI_SUCCESS &&
      material.Get(AI_MATKEY_COLOR_DIFFUSE, c) != AI_SUCCESS)
    return {};
  if (c.r == kAssimpsGrey && c.g == kAssimpsGrey && c.b == kAssimpsGrey) return {};
  return Colour{colour_code(double(c.r)), colour_code(double(c.g)), colour_code(double(c.b))};
}

// Sends the meshes of a scene, node by node.
class Sender {
 public:
  Sender(const std::string& path, const aiScene& scene, NamedMeshSender* out)
      : path_(path), scene_(scene), out_(*out) {}

  void send_node(const aiNode& node, const Affine& parent, std::string names, int depth) {
    if (depth > kMaxNodeDepth) fail_input(path_, "has nodes nested too deeply");
    const Affine to_world = compose(parent, affine_of(node.mTransformation));
    if (depth > 0) names += '\0';
    names += node.mName.C_Str();
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      send_mesh(*scene_.mMeshes[node.mMeshes[i]], to_world, names);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      send_node(*node.mChildren[i], to_world, names, depth + 1);
  }

 private:
  void send_mesh(const aiMesh& mesh, const Affine& to_world, const std::string& names) {
    NamedMeshHead head{{}, mesh.mNumVertices, is_mirror(to_world), false};
    head.is_undeformed = mesh.mNumBones > 0 || mesh.mNumAnimMeshes > 0;
    if ((mesh.mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0)
      head.left_out.add(Omission::kPointsOrLines);
    if (mesh.HasVertexColors(0)) head.left_out.add(Omission::kVertexColours);
    out_.begin(head, names);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      out_.vertex(to_world({double(p.x), double(p.y), double(p.z)}));
    }
    send_material(mesh.mMaterialIndex);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // a point or a line
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          fail_input(path_, "has a face with a corner that does not exist");
      }
      out_.polygon({face.mIndices, face.mNumIndices});
    }
    out_.end();
  }

  void send_material(unsigned index) {
    if (index >= scene_.mNumMaterials) return out_.material("", {});
    const aiMaterial& material = *scene_.mMaterials[index];
    const std::string name = material.GetName().C_Str();
    if (name == AI_DEFAULT_MATERIAL_NAME || name == "%%%DEFAULT") return out_.material("", {});
    out_.material(name, colour_of(material));
  }

  const std::string& path_;
  const aiScene& scene_;
  NamedMeshSender& out_;
};

void append_utf8(uint32_t c, std::string* out) {
  const auto put = [&](uint32_t byte) { out->push_back(char(byte)); };
  if (c < 0x80) return put(c);
  if (c >= 0x10000) put(0xF0 | c >> 18), put(0x80 | (c >> 12 & 0x3F));
  if (c >= 0x800 && c < 0x10000) put(0xE0 | c >> 12);
  if (c >= 0x800) put(0x80 | (c >> 6 & 0x3F));
  if (c < 0x800) put(0xC0 | c >> 6);
  put(0x80 | (c & 0x3F));
}

// Text in UTF-8 of text in UTF-16 with a byte order mark; other text is returned as it is.
std::string utf8_text(std::span<const std::byte> bytes) {
  const auto at = [&](size_t i) { return uint32_t(bytes[i]); };
  const bool big = bytes.size() > 1 && at(0) == 0xFE && at(1) == 0xFF;
  if (!big && !(bytes.size() > 1 && at(0) == 0xFF && at(1) == 0xFE))
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  const auto unit = [&](size_t i) { return at(i + big) | at(i + !big) << 8; };
  std::string text;
  for (size_t i = 2; i + 1 < bytes.size(); i += 2) {
    uint32_t c = unit(i);
    const bool pair = c >= 0xD800 && c < 0xDC00 && i + 3 < bytes.size();
    if (pair) c = 0x10000 + ((c - 0xD800) << 10) + (unit(i += 2) & 0x3FF);
    append_utf8(c, &text);
  }
  return text;
}

// Without blanks between a tag and a number: Assimp takes "<color> 1 0 0 1</color>" for an error.
std::string without_leading_blanks(const std::string& text) {
  std::string tight;
  tight.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    tight += text[i];
    if (text[i] != '>') continue;
    const size_t next = std::min(text.find_first_not_of(" \t\r\n", i + 1), text.size() - 1);
    if ((text[next] >= '0' && text[next] <= '9') || text[next] == '-' || text[next] == '.')
      i = next - 1;
  }
  return tight;
}

// `hint`: Assimp chooses its reader by it.
LeftOut read_with_assimp(const File& file, const char* format, const char* hint,
                         const ReadOptions& options, MeshWriter* out) {
  return read_named_meshes(
      file, format, options, out,
      [&](std::span<const std::byte> bytes, const std::string& path, NamedMeshSender* sender) {
        Assimp::Importer importer;
        const aiScene* scene = nullptr;
        std::string text;
        if (hint == kCollada) {
          text = without_leading_blanks(utf8_text(bytes));
          bytes = std::as_bytes(std::span(text));
        }
        try {
          scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, hint);
        } catch (const std::bad_alloc&) {
          throw;
        } catch (const std::exception&) {
        }
        // Assimp catches std::bad_alloc.
        const std::string why = importer.GetErrorString();
        if (why.find("bad_alloc") != why.npos) throw std::bad_alloc();
        if (scene == nullptr || scene->mRootNode == nullptr)
          fail_input(path, std::string("is not a valid ") + format + " file: " + why);
        Sender(path, *scene, sender).send_node(*scene->mRootNode, {}, {}, 0);
      });
}

}  // namespace

LeftOut read_collada(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, "COLLADA", kCollada, options, out);
}
LeftOut read_3ds(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, "3DS", "3ds", options, out);
}

}  // namespace svdag
