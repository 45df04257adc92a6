#include "io/scene/gltf/document/tile.h"

#include <cmath>

#include "io/scene/gltf/document/gltf_json.h"
#include "io/scene/gltf/document/gltf_uri.h"
#include "io/values/endian.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxUri = 65536;  // bytes

using Vector = std::array<double, 3>;

uint32_t word(const File& file, uint64_t offset) {
  std::array<std::byte, 4> bytes;
  file.read_at(offset, bytes);
  return load_little<uint32_t>(bytes.data());
}

Affine y_up_to_z_up() {
  Affine turn;
  turn.m[0] = {1, 0, 0, 0};
  turn.m[1] = {0, 0, -1, 0};
  turn.m[2] = {0, 1, 0, 0};
  return turn;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A direction of octahedral coordinates from -1 to 1.
Vector from_octahedral(double x, double y) {
  Vector v = {x, y, (1 - std::abs(x)) - std::abs(y)};
  if (v[2] < 0) {
    v[0] = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    v[1] = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
  }
  const double length = std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
  for (double& each : v) each /= length;
  return v;
}

}  // namespace

bool begins_as_batched_tile(std::string_view start) {
  return start.starts_with(std::string_view("b3dm\1\0\0\0", 8));
}

bool begins_as_instanced_tile(std::string_view start) {
  return start.starts_with(std::string_view("i3dm\1\0\0\0", 8));
}

Tile::Tile(const File& file, MemoryBudget* budget)
    : file_(file), bytes_{0, file.size()}, memory_(budget->reserve(0, "parts of glTF files")) {
  std::array<char, 8> head{};
  file.read_some_at(0, std::as_writable_bytes(std::span(head)));
  const std::string_view start(head.data(), head.size());
  is_instanced_ = begins_as_instanced_tile(start);
  is_tile_ = is_instanced_ || begins_as_batched_tile(start);
  if (!is_tile_) return;
  if (file.size() < 32) fail_input(file.path(), "is cut off inside the header of a tile");
  bytes_.end = word(file, 8);
  if (bytes_.end > file.size())
    fail_input(file.path(), "is cut off: the tile is shorter than it says", 8);
  is_instanced_ ? read_instanced() : read_features(28);
  global("RTC_CENTER", &centre_);
}

// Sets bytes_.begin to the end of all tables.
void Tile::read_features(uint64_t begin) {
  const uint64_t json_bytes = word(file_, 12), binary_bytes = word(file_, 16);
  const uint64_t tables[] = {json_bytes, binary_bytes, word(file_, 20), word(file_, 24)};
  uint64_t end = begin;
  for (const uint64_t bytes : tables) end += bytes;  // of 32 bits each
  if (end > bytes_.end) fail_input(file_.path(), "has tables that are longer than the tile");
  features_ = json_bytes == 0
                  ? nlohmann::json::object()
                  : parse_gltf_json(file_, begin, begin + json_bytes, {.all = true}, &memory_);
  if (!features_.is_object()) fail_input(file_.path(), "has a feature table that is not an object");
  binary_begin_ = begin + json_bytes;
  binary_bytes_ = binary_bytes;
  bytes_.begin = end;
}

void Tile::read_instanced() {
  const uint32_t format = word(file_, 28);
  read_features(32);
  instances_ = features().whole_number("INSTANCES_LENGTH");
  if (features().flag("EAST_NORTH_UP") && !features().has("NORMAL_UP") &&
      !features().has("NORMAL_UP_OCT32P"))
    fail_input(file_.path(),
               "has instances that are oriented by EAST_NORTH_UP, which svdag does not read");
  // Instances multiply triangles, so each must have bytes in the file.
  if (features().has("POSITION")) {
    binary_offset("POSITION", 12);
  } else if (features().has("POSITION_QUANTIZED")) {
    binary_offset("POSITION_QUANTIZED", 6);
  } else if (instances_ > 0) {
    fail_input(file_.path(), "has instances without positions");
  }
  if (format == 1) return;
  if (format != 0) fail_input(file_.path(), "has an unknown kind of glTF content", 28);
  const uint64_t length = bytes_.end - bytes_.begin;
  if (length > kMaxUri) fail_input(file_.path(), "has a URI that is too long");
  std::string uri(size_t(length), '\0');
  file_.read_at(bytes_.begin, std::as_writable_bytes(std::span(uri)));
  while (!uri.empty() && (uri.back() == ' ' || uri.back() == '\0')) uri.pop_back();
  beside_ = open_beside(file_.path(), uri, "glTF file");
  bytes_ = {0, beside_->size()};
}

uint64_t Tile::binary_offset(const char* key, uint64_t bytes) const {
  const uint64_t offset = features().object(key).whole_number("byteOffset");
  if (offset > binary_bytes_ || instances_ > (binary_bytes_ - offset) / bytes)
    fail_input(file_.path(), "has " + std::to_string(instances_) +
                                 " instances, more than its feature table can hold");
  return binary_begin_ + offset;
}

template <class Component>
Vector Tile::values(const char* key, uint64_t instance, int components) const {
  const uint64_t bytes = uint64_t(components) * sizeof(Component);
  std::array<std::byte, 3 * sizeof(Component)> raw{};
  file_.read_at(binary_offset(key, bytes) + instance * bytes, std::span(raw).first(size_t(bytes)));
  Vector out{};
  for (size_t i = 0; i < size_t(components); ++i)
    out[i] = double(load_little<Component>(raw.data() + i * sizeof(Component)));
  return out;
}

bool Tile::global(const char* key, Vector* out) const {
  const auto found = features_.find(key);
  if (found == features_.end()) return false;
  if (!found->is_object()) return features().numbers(key, *out);
  const uint64_t offset = features().object(key).whole_number("byteOffset");
  std::array<std::byte, 3 * sizeof(float)> raw;
  if (offset > binary_bytes_ || raw.size() > binary_bytes_ - offset)
    fail_input(file_.path(), std::string("has a ") + key + " outside its feature table");
  file_.read_at(binary_begin_ + offset, raw);
  for (size_t i = 0; i < 3; ++i)
    (*out)[i] = double(load_little<float>(raw.data() + i * sizeof(float)));
  return true;
}

Vector Tile::direction(const char* key, const char* octahedral, uint64_t instance) const {
  if (features().has(key)) return values<float>(key, instance, 3);
  if (!features().has(octahedral))
    fail_input(file_.path(), "has instances with only one of two directions");
  const Vector v = values<uint16_t>(octahedral, instance, 2);
  return from_octahedral(v[0] / 65535 * 2 - 1, v[1] / 65535 * 2 - 1);
}

Affine Tile::placement(uint64_t instance) const {
  if (!is_tile_) return {};
  Affine place;
  Vector position{0, 0, 0};
  if (is_instanced_) {
    if (features().has("POSITION")) {
      position = values<float>("POSITION", instance, 3);
    } else {
      Vector offset, scale;
      if (!global("QUANTIZED_VOLUME_OFFSET", &offset) || !global("QUANTIZED_VOLUME_SCALE", &scale))
        fail_input(file_.path(), "has quantised positions without their volume");
      position = values<uint16_t>("POSITION_QUANTIZED", instance, 3);
      for (size_t i = 0; i < 3; ++i) position[i] = position[i] / 65535 * scale[i] + offset[i];
    }
    std::array<Vector, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    if (features().has("NORMAL_UP") || features().has("NORMAL_UP_OCT32P") ||
        features().has("NORMAL_RIGHT") || features().has("NORMAL_RIGHT_OCT32P")) {
      axes[0] = direction("NORMAL_RIGHT", "NORMAL_RIGHT_OCT32P", instance);
      axes[1] = direction("NORMAL_UP", "NORMAL_UP_OCT32P", instance);
      axes[2] = cross(axes[0], axes[1]);
    }
    Vector scale{1, 1, 1};
    if (features().has("SCALE")) scale.fill(values<float>("SCALE", instance, 1)[0]);
    if (features().has("SCALE_NON_UNIFORM")) {
      const Vector more = values<float>("SCALE_NON_UNIFORM", instance, 3);
      for (size_t i = 0; i < 3; ++i) scale[i] *= more[i];
    }
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 3; ++column)
        place.m[row][column] = axes[column][row] * scale[column];
    }
  }
  for (size_t row = 0; row < 3; ++row) place.m[row][3] = position[row] + centre_[row];
  return compose(place, y_up_to_z_up());
}

}  // namespace svdag
