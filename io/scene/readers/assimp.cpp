// Reads FBX, COLLADA, 3MF and 3DS with Assimp.
//
// Assimp holds the whole scene, so these formats are not streamed. It
// parses untrusted bytes, so it always runs in a process of its own; under --sandbox, one that can
// only compute. Its positions are floats; the transforms of nodes are composed here, in double.
// Polygons are passed on as they are: Assimp's own triangulation may drop some.
//
// Files that name their vertical axis are turned so that y is up: COLLADA and 3DS by Assimp, FBX
// here. COLLADA comes in metres, the others in the units of the file.
//
// The colour of a material is its base or diffuse colour, which is sRGB; its textures are not read.
//
// The child sends of each mesh: a MeshHead; the material and the names of the nodes from the root
// on, separated by zero bytes; its vertices and polygons.
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <optional>
#include <string_view>

#include "io/affine.h"
#include "io/scene/readers/decoded_mesh.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Messages of the child.
enum AssimpMessage : uint64_t { kMeshHead = kOtherMessage, kMeshNames };

struct MeshHead {
  uint8_t undeformed = 0;
  uint8_t has_colour = 0;
  uint8_t is_mirrored = 0;
  uint8_t has_lines = 0;  // or points
  Colour colour;
  uint64_t vertices = 0;
};

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
  Sender(const File& file, const aiScene& scene, DecoderOutput* out)
      : file_(file), scene_(scene), out_(*out) {}

  void send_node(const aiNode& node, const Affine& parent, const std::string& parent_names,
                 int depth) {
    if (depth > kMaxNodeDepth) fail_input(file_.path(), "has nodes nested too deeply");
    const Affine to_world = compose(parent, affine_of(node.mTransformation));
    const std::string names = parent_names + '\0' + node.mName.C_Str();
    for (unsigned i = 0; i < node.mNumMeshes; ++i)
      send_mesh(*scene_.mMeshes[node.mMeshes[i]], to_world, names);
    for (unsigned i = 0; i < node.mNumChildren; ++i)
      send_node(*node.mChildren[i], to_world, names, depth + 1);
  }

 private:
  void send_mesh(const aiMesh& mesh, const Affine& to_world, const std::string& names) {
    std::string material;
    std::optional<Colour> colour;
    if (mesh.mMaterialIndex < scene_.mNumMaterials) {
      material = scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
      colour = colour_of(*scene_.mMaterials[mesh.mMaterialIndex]);
    }
    if (material == AI_DEFAULT_MATERIAL_NAME || material == "%%%DEFAULT") {
      material.clear();
      colour.reset();
    }
    const bool undeformed = mesh.mNumBones > 0 || mesh.mNumAnimMeshes > 0;
    const bool has_lines =
        (mesh.mPrimitiveTypes & (aiPrimitiveType_POINT | aiPrimitiveType_LINE)) != 0;
    const MeshHead head{undeformed, colour.has_value(),        is_mirror(to_world),
                        has_lines,  colour.value_or(Colour()), mesh.mNumVertices};
    out_.send_one(kMeshHead, head);
    out_.send_text(kMeshNames, material + names);
    DecodedMeshSender out(&out_);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      out.vertex(to_world({double(p.x), double(p.y), double(p.z)}));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // a point or a line
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          fail_input(file_.path(), "has a face with a corner that does not exist");
      }
      out.polygon({face.mIndices, face.mNumIndices});
    }
    out.finish();
  }

  const File& file_;
  const aiScene& scene_;
  DecoderOutput& out_;
};

// FBX stores the number of its vertical axis, and its sign.
Affine up_axis_to_y(const aiScene& scene) {
  int axis = 1, sign = 1;
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get("UpAxis", axis) || axis < 0 || axis > 2)
    return {};
  scene.mMetaData->Get("UpAxisSign", sign);
  return parse_up((sign < 0 ? "-" : "") + std::string(1, "xyz"[axis]));
}

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

struct AssimpFormat {
  std::string name;
  const char* hint;  // Assimp chooses its reader by it
};

void decode_scene(const File& file, std::span<const std::byte> bytes, const AssimpFormat& format,
                  DecoderOutput* out) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene = nullptr;
  std::string text;
  if (format.name == "COLLADA") {
    text = without_leading_blanks(utf8_text(bytes));
    bytes = std::as_bytes(std::span(text));
  }
  try {
    scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format.hint);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
  }
  // Assimp catches std::bad_alloc.
  const std::string why = importer.GetErrorString();
  if (why.find("bad_alloc") != why.npos) throw std::bad_alloc();
  if (scene == nullptr || scene->mRootNode == nullptr)
    fail_input(file.path(), "is not a valid " + format.name + " file: " + why);
  Sender(file, *scene, out).send_node(*scene->mRootNode, up_axis_to_y(*scene), {}, 0);
}

// Passes on the meshes of a child, by the names of their headers.
class Receiver {
 public:
  Receiver(const ReadOptions& options, MeshWriter* out)
      : options_(options), out_(*out), mesh_(out) {}

  const LeftOut& left_out() const { return left_out_; }

  void take(const DecoderMessage& message) {
    if (message.kind() == kMeshHead) {
      head_ = message.record<MeshHead>();
      wanted_ = false;
    } else if (message.kind() == kMeshNames) {
      take_names(message.text());
    } else if (wanted_) {
      mesh_.receive(message);
    }
  }

 private:
  void take_names(std::string_view text) {
    const std::string material(text.substr(0, text.find('\0')));
    const NameFilter& filter = *options_.names;
    // All are called in any case: they record which patterns match.
    bool included = filter.includes(PartKind::kMaterial, material) || options_.file_included;
    bool excluded = filter.excludes(PartKind::kMaterial, material);
    std::string name;
    for (size_t at = text.find('\0'); at != text.npos; at = text.find('\0', at + 1)) {
      name = text.substr(at + 1, text.find('\0', at + 1) - at - 1);
      included |= filter.includes(PartKind::kObject, name);
      excluded |= filter.excludes(PartKind::kObject, name);
    }
    wanted_ = included && !excluded;
    if (!wanted_) return;
    if (head_.has_lines != 0) left_out_.add(Omission::kPointsOrLines);
    mesh_.begin(head_.vertices);
    out_.mirrored(head_.is_mirrored != 0);
    out_.mesh(name, head_.undeformed != 0);
    out_.material(material, head_.has_colour != 0 ? std::optional(head_.colour) : std::nullopt);
  }

  const ReadOptions& options_;
  MeshWriter& out_;
  DecodedMeshReceiver mesh_;
  MeshHead head_;
  LeftOut left_out_;
  bool wanted_ = false;
};

LeftOut read_with_assimp(const File& file, const AssimpFormat& format, const ReadOptions& options,
                         MeshWriter* out) {
  const auto memory = options.budget->reserve(file.size(), (format.name + " files").c_str());
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  Receiver receiver(options, out);
  run_decoder(
      decoder_limits(bytes.size(), *options.budget), file.path(), options.sandbox,
      [&](DecoderOutput& decoder) { decode_scene(file, bytes, format, &decoder); },
      [&](const DecoderMessage& message) { receiver.take(message); });
  return receiver.left_out();
}

}  // namespace

LeftOut read_fbx(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, {"FBX", "fbx"}, options, out);
}
LeftOut read_collada(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, {"COLLADA", "dae"}, options, out);
}
LeftOut read_3mf(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, {"3MF", "3mf"}, options, out);
}
LeftOut read_3ds(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_with_assimp(file, {"3DS", "3ds"}, options, out);
}

}  // namespace svdag
