// Reads 3MF: core and production specification, with minizip and expat.
//
// The child unpacks and parses the parts that the build refers to, each once, and holds their
// objects; it sends one mesh per instance. An object is found by its part and its number: numbers
// are unique in a part only. Coordinates keep the unit of the file; decimals are read as doubles.
// Beam lattices and slices are counted, not baked; so are items that are not to be printed.
//
// Rejected: lib3mf 1.8.1, which Debian has (it does not find objects of other parts, "Could not
// find Object associated to Component": every file of Bambu Studio and OrcaSlicer; it rounds to
// floats); Assimp 5.2.5 (neither, and it frees thumbnails twice).
#include <algorithm>
#include <numeric>
#include <string>

#include "io/scene/decoders/zip_archive.h"
#include "io/scene/readers/named_mesh.h"
#include "io/scene/readers/three_mf_model.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr int kMaxComponentDepth = 512;  // the walk recurses

class ThreeMfSender {
 public:
  ThreeMfSender(std::span<const std::byte> bytes, const std::string& path, NamedMeshSender* out)
      : archive_(bytes, path, "3MF"), path_(path), out_(*out) {}

  void send() {
    const std::string root = root_name();
    const ThreeMfModel& model = part(root);
    out_.unit(model.unit_metres);
    for (const ThreeMfReference& item : model.items) {
      if (item.is_printable) {
        send_reference(item, root, {}, {}, 0);
      } else {
        left_out_.add(Omission::kNotPrintable);
      }
    }
    out_.left_out(left_out_);
  }

 private:
  XmlSource source_of(const std::string& name) const {
    return [this, name](const ZipArchive::PieceSink& sink) {
      if (!archive_.unpack(name, sink))
        fail_input(path_, "is not a valid 3MF file: it has no part " + name.substr(0, 255));
    };
  }

  std::string root_name() const {
    const std::string relationships = "_rels/.rels", usual = "3D/3dmodel.model";
    if (!archive_.unpack(relationships, [](std::string_view, bool) {})) return usual;
    const std::string name =
        parse_three_mf_relationships(source_of(relationships), where(relationships));
    return name.empty() ? usual : name;
  }

  std::string where(const std::string& name) const {
    return path_ + " (" + name.substr(0, 255) + ")";
  }

  ThreeMfModel& part(const std::string& name) {
    const auto found = parts_.find(name);
    if (found != parts_.end()) return found->second;
    return parts_.emplace(name, parse_three_mf_model(source_of(name), where(name))).first->second;
  }

  void send_reference(const ThreeMfReference& reference, const std::string& parent_part,
                      const Affine& parent, const std::string& parent_names, int depth) {
    const std::string& name = reference.part.empty() ? parent_part : reference.part;
    ThreeMfModel& model = part(name);
    const auto found = model.objects.find(reference.object);
    const std::string number = std::to_string(reference.object);
    if (found == model.objects.end())
      fail_input(where(name), "has no object " + number + ", which is referred to");
    ThreeMfObject& object = found->second;
    if (object.is_open) fail_input(where(name), "object " + number + " contains itself");
    if (depth > kMaxComponentDepth) fail_input(path_, "has components nested too deeply");
    object.is_open = true;
    const Affine to_world = compose(parent, reference.to_parent);
    std::string names = parent_names;
    for (const std::string& each : {object.name, "Object_" + number}) {
      if (each.empty()) continue;
      if (!names.empty()) names += '\0';
      names += each;
    }
    if (object.triangles.empty()) {
      left_out_ += object.left_out;
    } else {
      send_mesh(object, model, to_world, names);
    }
    for (const ThreeMfReference& component : object.components)
      send_reference(component, name, to_world, names, depth + 1);
    object.is_open = false;
  }

  void send_mesh(const ThreeMfObject& object, const ThreeMfModel& model, const Affine& to_world,
                 const std::string& names) {
    LeftOut left_out = object.left_out;
    const auto has_colours = [&](const ThreeMfProperty& property) {
      return property.first != 0 && !model.materials.contains(property.first);
    };
    if (std::any_of(object.properties.begin(), object.properties.end(), has_colours))
      left_out.add(Omission::kVertexColours);
    out_.begin({left_out, object.vertices.size(), is_mirror(to_world)}, names);
    for (const Point& p : object.vertices) out_.vertex(to_world(p));
    std::vector<uint32_t> order(object.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    if (object.properties.size() > 1)
      std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return object.property_of[a] < object.property_of[b];
      });
    for (size_t i = 0; i < order.size(); ++i) {
      const uint32_t property = object.property_of[order[i]];
      if (i == 0 || property != object.property_of[order[i - 1]])
        send_material(model, object.properties[property]);
      out_.polygon(object.triangles[order[i]]);
    }
    out_.end();
  }

  void send_material(const ThreeMfModel& model, const ThreeMfProperty& property) {
    const auto [group, index] = property;
    const auto found = model.materials.find(group);
    if (found == model.materials.end()) return out_.material("", {});
    if (index >= found->second.size())
      fail_input(path_, "is not a valid 3MF file: material " + std::to_string(index) +
                            " of group " + std::to_string(group) + " does not exist");
    const ThreeMfMaterial& material = found->second[index];
    out_.material("id" + std::to_string(group) + "_" + material.name, material.colour);
  }

  const ZipArchive archive_;
  const std::string& path_;
  NamedMeshSender& out_;
  std::map<std::string, ThreeMfModel> parts_;
  LeftOut left_out_;
};

}  // namespace

LeftOut read_3mf(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_named_meshes(
      file, "3MF", options, out,
      [](std::span<const std::byte> bytes, const std::string& path, NamedMeshSender* sender) {
        ThreeMfSender(bytes, path, sender).send();
      });
}

}  // namespace svdag
