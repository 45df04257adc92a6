#include "tests/scenes/glb_writer.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "streaming/error.h"
#include "tests/scenes/large_writes.h"
#include "tests/scenes/materials.h"
#include "tests/scenes/numbers.h"
#include "tests/scenes/rig.h"

namespace svdag::scenes {
namespace {

using Json = nlohmann::ordered_json;

enum Type { kByte = 5121, kIndex = 5125, kFloat = 5126 };
// Bytes of a vertex: position, both charts, colour; with a rig joints and weights, too.
constexpr size_t kWhole = 12, kAlong = 20, kColour = 28, kJoints = 32, kWeights = 36;

size_t stride_of(const Mesh& mesh) {
  return mesh.rig() ? kWeights + 4 : kJoints;
}

// Triangles of one part and material, and the vertices that only they use.
struct Run {
  std::string part;
  const Material* material;
  uint64_t first_face, faces;
  uint64_t first_vertex, vertices;
};

std::vector<Run> runs_of(const Mesh& mesh, const std::string& path) {
  std::vector<Run> runs;
  uint64_t end = 0;
  for (uint64_t i = 0; i < mesh.faces(); ++i) {
    std::string part = mesh.part(i), name = mesh.material(i);
    if (runs.empty() || part != runs.back().part || name != runs.back().material->name) {
      const Material* const material = find_material(name);
      if (!material)
        fail_usage(path + ": this scene has no textures or movement: write a .ply or an .obj");
      runs.push_back({std::move(part), material, i, 0, end, 0});
    }
    Run& run = runs.back();
    const Face face = mesh.face(i);
    ++run.faces;
    end = std::max(end, std::max({face[0], face[1], face[2]}) + 1);
    run.vertices = end - run.first_vertex;
  }
  return runs;
}

// The document, and the bytes of its images and of its skeleton. Vertices and indices follow them.
class Document {
 public:
  Document(const Mesh& mesh, const PlyOptions& options, const std::vector<Run>& runs)
      : mesh_(mesh) {
    json_ = {
        {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};
    add_materials(runs);
    if (mesh.rig()) add_rig(*mesh.rig());
    const uint64_t vertex_bytes = mesh.vertices() * stride_of(mesh);
    vertices_ = add_view(bytes_.size(), vertex_bytes);
    json_["bufferViews"].back()["byteStride"] = stride_of(mesh);
    indices_ = add_view(bytes_.size() + vertex_bytes, mesh.faces() * 12);
    size_ = bytes_.size() + vertex_bytes + mesh.faces() * 12;
    json_["buffers"] = {{{"byteLength", size_}}};
    for (const Run& run : runs) add_primitive(run, options);
    if (mesh.rig()) {
      for (Json& node : json_["nodes"]) {
        if (node.contains("mesh")) node["skin"] = 0;
      }
    }
  }

  std::string text() const {
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
  }
  const std::string& bytes() const { return bytes_; }
  uint64_t size() const { return size_; }  // of the whole buffer

 private:
  size_t add_to(const char* list, Json value) {
    json_[list].push_back(std::move(value));
    return json_[list].size() - 1;
  }

  size_t add_view(uint64_t begin, uint64_t size) {
    return add_to("bufferViews", {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", size}});
  }
  size_t add_bytes(const std::string& bytes) {
    const size_t view = add_view(bytes_.size(), bytes.size());
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return view;
  }

  size_t add_accessor(size_t view, uint64_t begin, Type type, const char* shape, uint64_t count) {
    return add_to("accessors", {{"bufferView", view},
                                {"byteOffset", begin},
                                {"componentType", int(type)},
                                {"count", count},
                                {"type", shape}});
  }
  size_t add_floats(const std::vector<float>& values, const char* shape, size_t count) {
    const std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * 4);
    return add_accessor(add_bytes(bytes), 0, kFloat, shape, count);
  }

  void add_materials(const std::vector<Run>& runs) {
    std::map<const Texture*, size_t> textures;
    for (const Run& run : runs) {
      const Material& material = *run.material;
      if (materials_.contains(&material)) continue;
      Json base = {
          {"baseColorFactor", {material.factor[0], material.factor[1], material.factor[2], 1}},
          {"metallicFactor", 0}};
      if (const Texture* const texture = material.texture) {
        if (!textures.contains(texture)) {
          const size_t view = add_bytes(encoded(*texture));
          const size_t image = add_to(
              "images",
              {{"bufferView", view}, {"mimeType", texture->jpeg ? "image/jpeg" : "image/png"}});
          const size_t sampler = add_to(
              "samplers", {{"wrapS", int(material.wrapping)}, {"wrapT", int(material.wrapping)}});
          textures[texture] = add_to("textures", {{"source", image}, {"sampler", sampler}});
        }
        base["baseColorTexture"] = {{"index", textures[texture]}, {"texCoord", material.set}};
      }
      Json json = {{"name", material.name}, {"pbrMetallicRoughness", base}, {"doubleSided", true}};
      if (material.texture && material.texture->mask) json["alphaMode"] = "MASK";
      materials_[&material] = add_to("materials", json);
    }
  }

  void add_rig(const Rig& rig) {
    std::vector<float> inverse, times(rig.times.begin(), rig.times.end());
    Json numbers = Json::array(), channels = Json::array(), samplers = Json::array();
    const size_t input = add_floats(times, "SCALAR", times.size());
    json_["accessors"].back()["min"] = {times.front()};
    json_["accessors"].back()["max"] = {times.back()};
    for (size_t i = 0; i < rig.joints.size(); ++i) {
      const Joint& joint = rig.joints[i];
      const Point from = i == 0 ? Point(0) : rig.joints[joint.parent].at;
      const Point way = quantised(joint.at - from), at = quantised(joint.at);
      add_to("nodes", {{"name", joint.name}, {"translation", {way.x, way.y, way.z}}});
      numbers.push_back(i);
      if (i == 0)
        json_["scenes"][0]["nodes"].push_back(0);
      else
        json_["nodes"][joint.parent]["children"].push_back(i);
      inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, float(-at.x), float(-at.y),
                                     float(-at.z), 1});
      std::vector<float> turns;
      for (const Quaternion& turn : joint.turns)
        turns.insert(turns.end(), turn.begin(), turn.end());
      if (turns.empty()) continue;
      channels.push_back(
          {{"sampler", samplers.size()}, {"target", {{"node", i}, {"path", "rotation"}}}});
      samplers.push_back({{"input", input}, {"output", add_floats(turns, "VEC4", times.size())}});
    }
    json_["skins"] = {{{"joints", numbers},
                       {"inverseBindMatrices", add_floats(inverse, "MAT4", rig.joints.size())}}};
    json_["animations"] = {
        {{"name", rig.animation}, {"channels", channels}, {"samplers", samplers}}};
  }

  size_t add_attribute(const Run& run, uint64_t begin, Type type, const char* shape,
                       bool normalized = false) {
    const size_t accessor = add_accessor(vertices_, run.first_vertex * stride_of(mesh_) + begin,
                                         type, shape, run.vertices);
    if (normalized) json_["accessors"][accessor]["normalized"] = true;
    return accessor;
  }

  // Into the mesh of its part, which is a node of its own.
  void add_primitive(const Run& run, const PlyOptions& options) {
    if (!meshes_.contains(run.part)) {
      meshes_[run.part] = add_to("meshes", {{"name", run.part}, {"primitives", Json::array()}});
      json_["scenes"][0]["nodes"].push_back(
          add_to("nodes", {{"name", run.part}, {"mesh", meshes_[run.part]}}));
    }
    Json attributes = {{"POSITION", add_attribute(run, 0, kFloat, "VEC3")}};
    Box box;
    for (uint64_t i = 0; i < run.vertices; ++i)
      box.add(placed(mesh_, options, run.first_vertex + i));
    Json& positions = json_["accessors"].back();
    positions["min"] = {float(box.min.x), float(box.min.y), float(box.min.z)};
    positions["max"] = {float(box.max.x), float(box.max.y), float(box.max.z)};
    const Material& material = *run.material;
    if (material.texture) {
      const bool whole = material.set == 1 || material.chart == Chart::kWhole;
      attributes["TEXCOORD_0"] = add_attribute(run, whole ? kWhole : kAlong, kFloat, "VEC2");
      if (material.set == 1) attributes["TEXCOORD_1"] = add_attribute(run, kAlong, kFloat, "VEC2");
    }
    if (material.tinted) attributes["COLOR_0"] = add_attribute(run, kColour, kByte, "VEC4", true);
    if (mesh_.rig()) {
      attributes["JOINTS_0"] = add_attribute(run, kJoints, kByte, "VEC4");
      attributes["WEIGHTS_0"] = add_attribute(run, kWeights, kByte, "VEC4", true);
    }
    const size_t indices =
        add_accessor(indices_, run.first_face * 12, kIndex, "SCALAR", run.faces * 3);
    json_["meshes"][meshes_[run.part]]["primitives"].push_back(
        {{"attributes", attributes}, {"indices", indices}, {"material", materials_[&material]}});
  }

  const Mesh& mesh_;
  Json json_;
  std::string bytes_;
  uint64_t size_ = 0;
  size_t vertices_ = 0, indices_ = 0;  // buffer views
  std::map<const Material*, size_t> materials_;
  std::map<std::string, size_t> meshes_;
};

void put_bytes(LargeWrites* out, std::array<double, 4> values) {
  for (const double value : values) out->put(uint8_t(value + 0.5));
}

void put_vertex(const Mesh& mesh, const PlyOptions& options, const Material& material, uint64_t i,
                LargeWrites* out) {
  const Point p = placed(mesh, options, i);
  for (int a = 0; a < 3; ++a) out->put(float(p[a] + 0.0));
  const Charts charts = mesh.charts(i);
  for (const double x : charts.whole) out->put(float(x));
  for (const double x : charts.along) out->put(float(x / material.metres));
  const double tint = 200 + 55 * noise(5, {p.x * 4, p.y * 4, p.z * 4});
  put_bytes(out, {tint, tint, 0.9 * tint, 255});
  if (!mesh.rig()) return;
  const Grip grip = mesh.grip(i);
  const double share = std::floor(255 * grip.share + 0.5);
  put_bytes(out, {double(grip.joint), double(grip.other), 0, 0});
  put_bytes(out, {255 - share, share, 0, 0});
}

}  // namespace

void write_glb(const Mesh& mesh, const PlyOptions& options, const std::string& path) {
  if (options.shuffle) fail_usage("--shuffle: a .glb keeps the order of its parts: write a .ply");
  if (mesh.rig() && options.yaw != 0)
    fail_usage("--yaw: the joints of a .glb do not turn: write a .ply");
  const std::vector<Run> runs = runs_of(mesh, path);
  const Document document(mesh, options, runs);
  const std::string text = document.text();
  const uint64_t size = 28 + text.size() + document.size();
  if (size > UINT32_MAX)
    fail_usage("--triangles: the scene is too large for a .glb of 4 GiB: write a .ply");
  AtomicFile file(path);
  LargeWrites out(&file);
  for (const uint32_t word : {0x46546C67U, 2U, uint32_t(size), uint32_t(text.size()), 0x4E4F534AU})
    out.put(word);
  out.flush();
  file.append(text);
  for (const uint32_t word : {uint32_t(document.size()), 0x004E4942U}) out.put(word);
  out.flush();
  file.append(document.bytes());
  for (const Run& run : runs) {
    for (uint64_t i = 0; i < run.vertices; ++i)
      put_vertex(mesh, options, *run.material, run.first_vertex + i, &out);
  }
  for (const Run& run : runs) {
    for (uint64_t i = 0; i < run.faces; ++i) {
      for (const uint64_t v : mesh.face(run.first_face + i))
        out.put(uint32_t(v - run.first_vertex));
    }
  }
  out.flush();
  file.commit();
}

}  // namespace svdag::scenes
