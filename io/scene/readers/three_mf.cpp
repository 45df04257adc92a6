// Reads 3MF: core and production specification, with minizip and expat.
//
// The child unpacks and parses the parts that the build refers to, each once, and holds their
// objects; it sends one mesh per instance. An object is found by its part and its number: numbers
// are unique in a part only. Coordinates keep the unit of the file; decimals are read as doubles.
// Beam lattices and slices are counted, not baked; so are items that are not to be printed, and
// meshes with composite materials and multiproperties, which have no colour.
//
// Rejected: lib3mf 1.8.1, which Debian has (it does not find objects of other parts, "Could not
// find Object associated to Component": every file of Bambu Studio and OrcaSlicer; it rounds to
// floats); Assimp 5.2.5 (neither, and it frees thumbnails twice).
#include <algorithm>
#include <map>
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
  // `painted`: the colours of points are wanted.
  ThreeMfSender(std::span<const std::byte> bytes, const std::string& path, bool painted,
                NamedMeshSender* out)
      : archive_(bytes, path, "3MF"), path_(path), is_painted_(painted), out_(*out) {}

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
    return parts_.emplace(name, parse_three_mf_model(source_of(name), where(name), is_painted_))
        .first->second;
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
      send_mesh(object, name, model, to_world, names);
    }
    for (const ThreeMfReference& component : object.components)
      send_reference(component, name, to_world, names, depth + 1);
    object.is_open = false;
  }

  void send_mesh(const ThreeMfObject& object, const std::string& part, const ThreeMfModel& model,
                 const Affine& to_world, const std::string& names) {
    LeftOut left_out = object.left_out;
    const auto has_colours = [&](const ThreeMfProperty& property) {
      return property.first != 0 && !model.materials.contains(property.first) &&
             paint_of(model, property.first) == nullptr;
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
      const auto [group, first] = object.properties[property];
      const ThreeMfPaint* const paint = paint_of(model, group);
      const uint32_t before = i == 0 ? property : object.property_of[order[i - 1]];
      const bool is_same =
          paint != nullptr ? group == object.properties[before].first : property == before;
      if (i == 0 || !is_same) {
        send_material(model, object.properties[property]);
        if (paint != nullptr) send_paint(part, model, *paint);
      }
      if (paint == nullptr) {
        out_.polygon(object.triangles[order[i]]);
      } else {
        const auto [second, third] = object.other_corners[order[i]];
        const std::array<PaintedCorner, 3> corners = {corner_of(*paint, group, first),
                                                      corner_of(*paint, group, second),
                                                      corner_of(*paint, group, third)};
        out_.polygon(object.triangles[order[i]], corners);
      }
    }
    out_.end();
  }

  // Null: the group has none, or colours of points are not wanted.
  static const ThreeMfPaint* paint_of(const ThreeMfModel& model, uint32_t group) {
    const auto found = model.paints.find(group);
    return found != model.paints.end() ? &found->second : nullptr;
  }

  PaintedCorner corner_of(const ThreeMfPaint& paint, uint32_t group, uint32_t index) const {
    if (index >= paint.corners.size())
      fail_input(path_, "is not a valid 3MF file: element " + std::to_string(index) + " of group " +
                            std::to_string(group) + " does not exist");
    PaintedCorner corner = paint.corners[index];
    corner.v = 1 - corner.v;
    return corner;
  }

  void send_paint(const std::string& part, const ThreeMfModel& model, const ThreeMfPaint& paint) {
    if (paint.texture == 0) return out_.paint({});
    const auto image = model.images.find(paint.texture);
    if (image == model.images.end())
      fail_input(where(part), "has no texture " + std::to_string(paint.texture));
    NamedPaint use = image->second.use;
    const auto [sent, is_new] =
        images_.try_emplace(image->second.part, uint32_t(images_.size() + 1));
    if (is_new) send_image(image->second.part);
    use.image = sent->second;
    out_.paint(use);
  }

  // A part that the archive lacks is sent as an image of 0 bytes.
  void send_image(const std::string& name) {
    std::string bytes;
    archive_.unpack(name, [&](std::string_view piece, bool) { bytes += piece; });
    out_.image(name, std::as_bytes(std::span(bytes)));
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
  const bool is_painted_;
  NamedMeshSender& out_;
  std::map<std::string, uint32_t> images_;  // that were sent: their numbers by part
  std::map<std::string, ThreeMfModel> parts_;
  LeftOut left_out_;
};

}  // namespace

LeftOut read_3mf(const File& file, const ReadOptions& options, MeshWriter* out) {
  return read_named_meshes(
      file, "3MF", options, out,
      [&](std::span<const std::byte> bytes, const std::string& path, NamedMeshSender* sender) {
        ThreeMfSender(bytes, path, options.paints != nullptr, sender).send();
      });
}

}  // namespace svdag
