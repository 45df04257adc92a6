#include "io/scene/gltf/gltf_draco.h"

#include <algorithm>

#include "io/scene/gltf/gltf_cut_out.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Compressed bytes after which a child takes no further primitive.
constexpr uint64_t kChildBytes = uint64_t(1) << 18;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

}  // namespace

// Whether an accessor has data outside of Draco's.
bool DracoPrimitives::has_data(uint64_t accessor) const {
  return document_.element("accessors", accessor).has("bufferView");
}

bool DracoPrimitives::holds(const JsonObject& primitive) const {
  if (!primitive.extension(kDraco)) return false;
  return !has_data(primitive.object("attributes").whole_number("POSITION")) ||
         (primitive.has("indices") && !has_data(primitive.whole_number("indices")));
}

JsonObject DracoPrimitives::attributes_of(const JsonObject& primitive) const {
  if (!holds(primitive)) return primitive.object("attributes");
  return primitive.extension(kDraco)->object("attributes");
}

bool DracoPrimitives::has_texture(const JsonObject& primitive) const {
  if (options_.paints != nullptr) return true;
  if (options_.alpha == nullptr || !primitive.has("material")) return false;
  const uint64_t material = primitive.whole_number("material");
  return material < document_.root().array("materials").size() &&
         is_cut_out(document_.element("materials", material), *options_.names);
}

DracoPrimitives::Packed DracoPrimitives::pack(const nlohmann::json& value) {
  const JsonObject primitive(value, document_.file->path());
  const JsonObject draco = *primitive.extension(kDraco);
  const JsonObject accessors = primitive.object("attributes"), ids = draco.object("attributes");
  const auto accessor_of = [&](const char* name) {
    return document_.element("accessors", accessors.whole_number(name));
  };
  Packed packed{&value, {}, {}, {}, {}};
  packed.bytes = buffers_.view_bytes(draco.whole_number("bufferView"), &packed.memory);
  packed.source = {
      packed.bytes, ids.whole_number("POSITION"), accessor_of("POSITION").flag("normalized"), {}};
  if (!has_texture(primitive)) return packed;
  for (const std::string& name : ids.names()) {
    const bool is_colour = name == "COLOR_0";
    if (!is_colour && !name.starts_with("TEXCOORD_")) continue;
    const uint64_t components = !is_colour                                      ? 2
                                : accessor_of("COLOR_0").text("type") == "VEC4" ? 4
                                                                                : 3;
    packed.names.push_back(name);
    packed.source.attributes.push_back({ids.whole_number(name.c_str()), components});
  }
  return packed;
}

// `primitive` and what follows it in the file, as far as it is not broken.
std::vector<DracoPrimitives::Packed> DracoPrimitives::pack_from(const nlohmann::json& primitive) {
  if (!listed_) {
    for (const auto& mesh : document_.root().array("meshes")) {
      for (const auto& each : JsonObject(mesh, document_.file->path()).array("primitives"))
        in_order_.push_back(&each);
    }
    std::sort(in_order_.begin(), in_order_.end());  // an array's elements ascend
    listed_ = true;
  }
  std::vector<Packed> packed;
  packed.push_back(pack(primitive));
  uint64_t bytes = packed.front().bytes.size();
  auto next = std::upper_bound(in_order_.begin(), in_order_.end(), &primitive);
  try {
    for (; next != in_order_.end() && bytes < kChildBytes; ++next) {
      if (unpacked_.contains(*next) || !holds(JsonObject(**next, document_.file->path()))) continue;
      packed.push_back(pack(**next));
      bytes += packed.back().bytes.size();
    }
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput && error.code() != ExitCode::kMemory) throw;
  }
  return packed;
}

void DracoPrimitives::unpack(const std::vector<Packed>& packed) {
  if (!file_) file_ = create_unpacked(document_.file->path(), options_.spill);
  std::vector<DracoSource> sources;
  for (const Packed& each : packed) sources.push_back(each.source);
  struct Place {
    uint64_t positions, attributes, indices, end;
    double step;
  };
  std::vector<Place> places;  // in the file
  const auto append = [&](std::span<const std::byte> bytes) {
    file_->write_at(file_bytes_, bytes);
    file_bytes_ += bytes.size();
    places.back().end = file_bytes_;
  };
  const DracoReceiver receiver = {
      [&](size_t source, double step) {
        places.resize(source);
        places.push_back({file_bytes_, file_bytes_, file_bytes_, file_bytes_, step});
      },
      [&](std::span<const Point> points) {
        append(std::as_bytes(points));
        places.back().attributes = places.back().indices = file_bytes_;
      },
      [&](std::span<const uint32_t> indices) { append(std::as_bytes(indices)); },
      [&](std::span<const double> values) {
        append(std::as_bytes(values));
        places.back().indices = file_bytes_;
      }};
  const size_t done =
      decode_draco(sources, document_.file->path(), *options_.budget, options_.sandbox, receiver);
  for (size_t i = 0; i < done; ++i) {
    const Place& at = places[i];
    Unpacked& made = unpacked_[packed[i].key];
    made.positions = Blob::in_file(&*file_, at.positions, at.attributes - at.positions);
    made.indices = Blob::in_file(&*file_, at.indices, at.end - at.indices);
    made.primitive.step = at.step;
    const std::string* path = &document_.file->path();
    made.primitive.positions = {{&made.positions, 0, sizeof(Point),
                                 made.positions.size() / sizeof(Point), ComponentType::kDouble, 3},
                                {},
                                {},
                                path};
    made.primitive.indices = {
        {&made.indices, 0, sizeof(uint32_t), made.indices.size() / sizeof(uint32_t),
         ComponentType::kUnsignedInt, 1},
        {},
        {},
        path};
    made.attributes = Blob::in_file(&*file_, at.attributes, at.indices - at.attributes);
    uint64_t begin = 0;
    for (size_t k = 0; k < packed[i].names.size(); ++k) {
      const uint64_t components = packed[i].source.attributes[k].components;
      const ElementArray values{&made.attributes,
                                begin,
                                components * sizeof(double),
                                made.primitive.positions.count(),
                                ComponentType::kDouble,
                                uint32_t(components)};
      begin += values.count * values.stride;
      made.primitive.attributes[packed[i].names[k]] = {values, {}, {}, path};
    }
  }
}

const DracoPrimitive* DracoPrimitives::find(const nlohmann::json& primitive) {
  auto known = unpacked_.find(&primitive);
  if (known == unpacked_.end()) {
    if (!holds(JsonObject(primitive, document_.file->path()))) return nullptr;
    unpack(pack_from(primitive));
    known = unpacked_.find(&primitive);
  }
  return &known->second.primitive;
}

}  // namespace svdag
