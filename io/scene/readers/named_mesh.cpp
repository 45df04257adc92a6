#include "io/scene/readers/named_mesh.h"

#include <cmath>

namespace svdag {
namespace {

enum NamedMeshMessage : uint64_t { kMeshHead = kOtherMessage, kMeshNames, kMaterial, kLeftOut, kUnit };

constexpr size_t kColourBytes = 4;  // before the name of a material: whether it has one, r, g, b

// Passes on the parts of meshes that are selected.
class NamedMeshReceiver {
 public:
  NamedMeshReceiver(const ReadOptions& options, MeshWriter* out)
      : options_(options), out_(*out), mesh_(out) {}

  void take(const DecoderMessage& message) {
    switch (message.kind()) {
      case kMeshHead:
        head_ = message.record<NamedMeshHead>();
        break;
      case kMeshNames:
        take_names(message.text());
        break;
      case kMaterial:
        take_material(message);
        break;
      case kLeftOut:
        left_out_ += message.record<LeftOut>();
        break;
      case kUnit:
        take_unit(message.record<double>());
        break;
      case kVertices:
        if (!excluded_) mesh_.receive(message);
        break;
      default:
        if (wanted_ || message.kind() != kPolygons) mesh_.receive(message);
    }
  }
  const LeftOut& left_out() const { return left_out_; }

 private:
  void take_names(std::string_view text) {
    included_ = options_.file_included;
    excluded_ = wanted_ = is_counted_ = false;
    std::string name;
    for (size_t at = 0; at <= text.size(); at += name.size() + 1) {
      name = text.substr(at, text.find('\0', at) - at);
      // Both are called in any case: they record which patterns match.
      included_ |= options_.names->includes(PartKind::kObject, name);
      excluded_ |= options_.names->excludes(PartKind::kObject, name);
    }
    if (excluded_) return;
    mesh_.begin(head_.vertices);
    out_.mirrored(head_.is_mirrored != 0);
    out_.mesh(name, head_.is_undeformed != 0);
  }
  void take_material(const DecoderMessage& message) {
    const std::string_view text = message.text();
    if (text.size() < kColourBytes) message.fail();
    const std::string name(text.substr(kColourBytes));
    const bool included = options_.names->includes(PartKind::kMaterial, name);
    const bool excluded = options_.names->excludes(PartKind::kMaterial, name);
    wanted_ = (included || included_) && !excluded && !excluded_;
    if (!wanted_) return;
    if (!is_counted_) left_out_ += head_.left_out;
    is_counted_ = true;
    std::optional<Colour> colour;
    if (text[0] != 0) colour = Colour{uint8_t(text[1]), uint8_t(text[2]), uint8_t(text[3])};
    out_.material(name, colour);
  }
  void take_unit(double metres) {
    if (options_.unit_metres != nullptr && std::isnormal(metres) && metres > 0)
      *options_.unit_metres = metres;
  }

  const ReadOptions& options_;
  MeshWriter& out_;
  DecodedMeshReceiver mesh_;
  NamedMeshHead head_;
  LeftOut left_out_;
  // Of the mesh: whether its names are selected; of its material: whether both are.
  bool included_ = false, excluded_ = true, wanted_ = false;
  bool is_counted_ = false;  // left_out_ contains that of the mesh
};

}  // namespace

void NamedMeshSender::begin(const NamedMeshHead& head, const std::string& names) {
  out_.send_one(kMeshHead, head);
  out_.send_text(kMeshNames, names);
}

void NamedMeshSender::material(const std::string& name, const std::optional<Colour>& colour) {
  mesh_.finish();
  const Colour c = colour.value_or(Colour());
  std::string text = {char(colour.has_value()), char(c.r), char(c.g), char(c.b)};
  out_.send_text(kMaterial, text += name);
}

void NamedMeshSender::left_out(const LeftOut& left_out) {
  out_.send_one(kLeftOut, left_out);
}

void NamedMeshSender::unit(double metres) {
  out_.send_one(kUnit, metres);
}

LeftOut read_named_meshes(const File& file, const char* format, const ReadOptions& options,
                          MeshWriter* out, const NamedMeshDecoder& decode) {
  const auto memory =
      options.budget->reserve(file.size(), (format + std::string(" files")).c_str());
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  NamedMeshReceiver receiver(options, out);
  run_decoder(
      decoder_limits(bytes.size(), *options.budget), file.path(), options.sandbox,
      [&](DecoderOutput& decoder) {
        NamedMeshSender sender(&decoder);
        decode(bytes, file.path(), &sender);
      },
      [&](const DecoderMessage& message) { receiver.take(message); });
  return receiver.left_out();
}

}  // namespace svdag
