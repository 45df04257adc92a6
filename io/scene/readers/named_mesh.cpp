#include "io/scene/readers/named_mesh.h"

#include <algorithm>
#include <cmath>

#include "io/scene/colours/linear_images.h"
#include "io/scene/decoders/image.h"
#include "streaming/error.h"

namespace svdag {
namespace {

enum NamedMeshMessage : uint64_t {
  kMeshHead = kOtherMessage,
  kMeshNames,
  kMaterial,
  kImageName,
  kImageBytes,
  kPaint,
  kLeftOut,
  kUnit
};

constexpr size_t kColourBytes = 4;  // before the name of a material: whether it has one, r, g, b

double factor_of(uint8_t code) {
  return double(light16_of_code(code)) / kWhite16;
}

// Passes on the parts of meshes that are selected.
class NamedMeshReceiver {
 public:
  NamedMeshReceiver(const File& file, const ReadOptions& options, MeshWriter* out)
      : path_(file.path()), options_(options), out_(*out), mesh_(out) {}

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
      case kImageName:
        add_image(message);
        break;
      case kImageBytes:
        take_image_bytes(message);
        break;
      case kPaint:
        take_paint(message);
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
        if (wanted_ || (message.kind() != kPolygons && message.kind() != kPaintedCorners))
          mesh_.receive(message);
    }
  }
  const LeftOut& left_out() const { return left_out_; }

 private:
  struct Image {
    std::string name;
    std::vector<std::byte> bytes;
    MemoryBudget::Reservation memory;
  };

  // Names are unique: images are decoded once by their name.
  void add_image(const DecoderMessage& message) {
    if (options_.paints == nullptr) message.fail();
    std::string name = path_ + ": " + std::string(message.text());
    if (std::ranges::find(images_, name, &Image::name) != images_.end())
      name += " (" + std::to_string(images_.size() + 1) + ")";
    images_.push_back({name, {}, {}});
  }
  void take_image_bytes(const DecoderMessage& message) {
    if (images_.empty()) message.fail();
    Image& image = images_.back();
    const size_t size = image.bytes.size() + message.bytes().size();
    check_image_bytes(size, image.name);
    if (size > image.bytes.capacity()) {
      const size_t room = std::max(size, 2 * image.bytes.capacity());
      image.memory = options_.budget->reserve(room + image.bytes.capacity(), "textures");
      image.bytes.reserve(room);
    }
    image.bytes.insert(image.bytes.end(), message.bytes().begin(), message.bytes().end());
  }
  // An image is held until it is decoded, once for all passes.
  void take_paint(const DecoderMessage& message) {
    const auto named = message.record<NamedPaint>();
    if (options_.paints == nullptr || named.image > images_.size() ||
        std::max(named.wrap_u, named.wrap_v) > Wrap::kClamp)
      message.fail();
    if (!wanted_) return;
    paint_ = Paint();
    if (named.image > 0) {
      Image& image = images_[named.image - 1];
      const auto bytes = [&](MemoryBudget::Reservation* memory) {
        if (image.bytes.empty()) fail_input(image.name, "this texture is not in the file");
        *memory = std::move(image.memory);
        return std::move(image.bytes);
      };
      paint_.image = options_.paints->image(image.name, 0, bytes);
      image.bytes = {};
      image.memory.release();
    }
    // An image replaces the colour of the material.
    if (!paint_.image && colour_)
      paint_.factor = {factor_of(colour_->r), factor_of(colour_->g), factor_of(colour_->b)};
    paint_.wrap_u = named.wrap_u;
    paint_.wrap_v = named.wrap_v;
    paint_.nearest = named.is_nearest != 0;
    mesh_.paint(&paint_);
  }
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
    mesh_.paint(nullptr);
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
    mesh_.paint(nullptr);
    if (!wanted_) return;
    if (!is_counted_) left_out_ += head_.left_out;
    is_counted_ = true;
    colour_.reset();
    if (text[0] != 0) colour_ = Colour{uint8_t(text[1]), uint8_t(text[2]), uint8_t(text[3])};
    out_.material(name, colour_);
  }
  void take_unit(double metres) {
    if (options_.unit_metres != nullptr && std::isnormal(metres) && metres > 0)
      *options_.unit_metres = metres;
  }

  const std::string& path_;
  const ReadOptions& options_;
  MeshWriter& out_;
  std::optional<Colour> colour_;  // of the material
  Paint paint_;                   // of the material
  std::vector<Image> images_;
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

void NamedMeshSender::image(const std::string& name, std::span<const std::byte> bytes) {
  mesh_.finish();
  out_.send_text(kImageName, name);
  if (!bytes.empty()) out_.send(kImageBytes, bytes);
}

void NamedMeshSender::paint(const NamedPaint& paint) {
  out_.send_one(kPaint, paint);
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
  NamedMeshReceiver receiver(file, options, out);
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
