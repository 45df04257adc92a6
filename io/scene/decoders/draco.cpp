#include "io/scene/decoders/draco.h"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "io/scene/decoders/limited_decoder.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxFree = uint64_t(1) << 18;
constexpr uint64_t kMaxPerByte = 1024;
// Draco's working memory, measured generously: corner table, faces, traversal state; each
// attribute with own seams has a corner table too.
constexpr uint64_t kBytesPerFace = 96;
constexpr uint64_t kBytesPerFaceAndAttribute = 32;
constexpr uint64_t kBytesPerPoint = 48;

// Checks the counts of a mesh against its bytes, and reserves the memory they need.
class Allowance {
 public:
  Allowance(const DracoSource& source, MemoryBudget* budget)
      : path_(source.path),
        limit_(kMaxFree + kMaxPerByte * source.bytes.size()),
        memory_(budget->reserve(0, "Draco meshes")) {}

  void connectivity(uint64_t faces, uint64_t points, uint64_t attributes) {
    check(faces);
    check(points);
    add(faces * (kBytesPerFace + attributes * kBytesPerFaceAndAttribute) + points * kBytesPerPoint);
  }

  // Portable and final values of every attribute, of points whose number is known by now.
  void attributes(const draco::PointCloud& cloud) {
    uint64_t per_point = 0;
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      const auto& a = *cloud.attribute(i);
      const uint64_t size = uint64_t(std::max(1, draco::DataTypeLength(a.data_type())));
      per_point += a.num_components() * (size + sizeof(int32_t)) + 2 * sizeof(uint32_t);
    }
    const uint64_t points = cloud.num_points();
    if (points * per_point > 128 * limit_) refuse(points * per_point);
    add(points * per_point);
  }

  MemoryBudget::Reservation take() { return std::move(memory_); }

 private:
  void check(uint64_t claim) const {
    if (claim > limit_) refuse(claim);
  }
  [[noreturn]] void refuse(uint64_t claim) const {
    fail_input(path_, "has Draco data that claims " + std::to_string(claim) +
                          " elements, which its bytes cannot hold");
  }
  void add(uint64_t bytes) { memory_.resize(memory_.bytes() + bytes, "Draco meshes"); }

  const std::string& path_;
  uint64_t limit_;
  MemoryBudget::Reservation memory_;
};

// A Draco decoder that checks the budget before its two large allocations. `Base` is one of
// Draco's decoders; its DecodeConnectivity begins with the counts that are read ahead here.
template <class Base>
class GuardedDecoder : public Base {
 public:
  explicit GuardedDecoder(Allowance* allowance) : allowance_(allowance) {}

 protected:
  static constexpr bool kEdgebreaker = std::is_same_v<Base, draco::MeshEdgebreakerDecoder>;

  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t first = 0, second = 0;
    int8_t seams = 0;
    // Edgebreaker before 2.2 has the number of new vertices in front.
    const bool extra = kEdgebreaker && this->bitstream_version() < version(2, 2);
    if (extra && !count(&ahead, &first)) return false;
    if (!count(&ahead, &first) || !count(&ahead, &second)) return false;
    if (kEdgebreaker && !ahead.Decode(&seams)) return false;
    const uint32_t faces = kEdgebreaker ? second : first;
    const uint32_t points = kEdgebreaker ? first : second;
    allowance_->connectivity(faces, points, uint64_t(std::max<int8_t>(seams, 0)));
    return Base::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    allowance_->attributes(*this->point_cloud());
    return Base::DecodeAllAttributes();
  }

 private:
  static constexpr uint16_t version(int major, int minor) { return uint16_t(major << 8 | minor); }

  bool count(draco::DecoderBuffer* buffer, uint32_t* value) const {
    const bool fixed = this->bitstream_version() < (kEdgebreaker ? version(2, 0) : version(2, 2));
    return fixed ? buffer->Decode(value) : draco::DecodeVarint(value, buffer);
  }

  Allowance* allowance_;
};

[[noreturn]] void fail_broken(const std::string& path, const std::string& reason) {
  fail_input(path, "has broken Draco data: " + reason);
}

template <class Base>
void run(const draco::DecoderOptions& options, Allowance* allowance, draco::DecoderBuffer* buffer,
         const std::string& path, draco::Mesh* mesh) {
  const draco::Status status = GuardedDecoder<Base>(allowance).Decode(options, buffer, mesh);
  if (!status.ok()) fail_broken(path, status.error_msg_string());
}

void decode_mesh(const DracoSource& source, Allowance* allowance, draco::Mesh* mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header;
  const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&ahead, &header);
  if (!status.ok()) fail_broken(source.path, status.error_msg_string());
  if (header.encoder_type == draco::POINT_CLOUD) {
    fail_input(source.path, "is a Draco point cloud, which has no triangles");
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH) fail_broken(source.path, "unknown geometry");
  draco::Decoder settings;  // keep positions as the integers that they were stored as
  settings.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
  const draco::DecoderOptions& options = *settings.options();
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
    run<draco::MeshSequentialDecoder>(options, allowance, &buffer, source.path, mesh);
  } else if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    run<draco::MeshEdgebreakerDecoder>(options, allowance, &buffer, source.path, mesh);
  } else {
    fail_broken(source.path, "unknown encoding");
  }
}

template <class Component>
void copy_positions(const draco::PointAttribute& attribute, bool normalized, DracoMesh* out) {
  std::array<Component, 3> v{};
  for (uint32_t i = 0; i < attribute.size(); ++i) {
    attribute.GetValue(draco::AttributeValueIndex(i), v.data());
    for (int c = 0; c < 3; ++c) {
      double value = double(v[size_t(c)]);
      if (normalized && std::is_integral_v<Component>) {
        value = std::max(value / double(std::numeric_limits<Component>::max()), -1.0);
      }
      out->positions[i][c] = value;
    }
  }
}

void read_positions(const draco::PointAttribute& attribute, const DracoSource& source,
                    DracoMesh* out) {
  const bool normalized = source.normalized || attribute.normalized();
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return copy_positions<int8_t>(attribute, normalized, out);
    case draco::DT_UINT8:
      return copy_positions<uint8_t>(attribute, normalized, out);
    case draco::DT_INT16:
      return copy_positions<int16_t>(attribute, normalized, out);
    case draco::DT_UINT16:
      return copy_positions<uint16_t>(attribute, normalized, out);
    case draco::DT_INT32:
      return copy_positions<int32_t>(attribute, normalized, out);
    case draco::DT_UINT32:
      return copy_positions<uint32_t>(attribute, normalized, out);
    case draco::DT_FLOAT32:
      return copy_positions<float>(attribute, normalized, out);
    case draco::DT_FLOAT64:
      return copy_positions<double>(attribute, normalized, out);
    default:
      fail_broken(source.path, "positions are of an unknown type");
  }
}

void read_quantized(const draco::PointAttribute& attribute, const DracoSource& source,
                    DracoMesh* out) {
  draco::AttributeQuantizationTransform transform;
  if (!transform.InitFromAttribute(attribute) || transform.quantization_bits() < 1 ||
      transform.quantization_bits() > 31 || transform.min_values().size() < 3) {
    fail_broken(source.path, "positions have no valid quantisation");
  }
  out->step = double(transform.range()) / double((1u << transform.quantization_bits()) - 1);
  DracoSource as_stored = source;
  as_stored.normalized = false;
  read_positions(attribute, as_stored, out);
  for (Point& p : out->positions) {
    for (int c = 0; c < 3; ++c) p[c] = double(transform.min_value(c)) + p[c] * out->step;
  }
}

DracoMesh copy_mesh(const draco::Mesh& mesh, const DracoSource& source) {
  const draco::PointAttribute* attribute =
      source.position_id ? mesh.GetAttributeByUniqueId(
                               uint32_t(std::min<uint64_t>(*source.position_id, UINT32_MAX)))
                         : mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (attribute == nullptr || attribute->num_components() != 3) {
    fail_broken(source.path, "it has no three-dimensional positions");
  }
  DracoMesh out;
  out.positions.resize(attribute->size());
  const auto* transform = attribute->GetAttributeTransformData();
  if (transform != nullptr &&
      transform->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) {
    read_quantized(*attribute, source, &out);
  } else {
    read_positions(*attribute, source, &out);
  }
  out.indices.reserve(size_t(mesh.num_faces()) * 3);
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
      const uint32_t value =
          point < mesh.num_points() ? attribute->mapped_index(point).value() : UINT32_MAX;
      if (value >= out.positions.size()) fail_broken(source.path, "a triangle has no such vertex");
      out.indices.push_back(value);
    }
  }
  return out;
}

DracoMesh decode_here(const DracoSource& source, MemoryBudget* budget) {
  Allowance allowance(source, budget);
  try {
    draco::Mesh mesh;
    decode_mesh(source, &allowance, &mesh);
    DracoMesh out = copy_mesh(mesh, source);
    out.memory = allowance.take();
    return out;
  } catch (const std::bad_alloc&) {
    fail_broken(source.path, "it requires too much memory");
  } catch (const std::length_error&) {
    fail_broken(source.path, "it requires too much memory");
  }
}

// A mesh received from a child, whose data is untrusted: counts, positions, indices.
class MeshReceiver {
 public:
  struct Counts {
    uint64_t positions, indices;
    double step;
  };

  MeshReceiver(const DracoSource& source, MemoryBudget* budget, DracoMesh* mesh)
      : source_(source), budget_(budget), mesh_(mesh) {}

  void operator()(std::span<const std::byte> bytes) {
    if (!begun_) return begin(bytes);
    const auto positions = std::as_writable_bytes(std::span(mesh_->positions));
    const auto indices = std::as_writable_bytes(std::span(mesh_->indices));
    const auto to = filled_ < positions.size() ? positions.subspan(filled_)
                                               : indices.subspan(filled_ - positions.size());
    require(bytes.size() <= to.size());
    std::copy(bytes.begin(), bytes.end(), to.begin());
    filled_ += bytes.size();
  }

  void finish() const {
    require(begun_ &&
            filled_ == mesh_->positions.size() * sizeof(Point) + mesh_->indices.size() * 4);
    for (const uint32_t index : mesh_->indices) require(index < mesh_->positions.size());
  }

 private:
  void begin(std::span<const std::byte> bytes) {
    Counts counts;
    require(bytes.size() == sizeof counts);
    std::memcpy(&counts, bytes.data(), sizeof counts);
    const uint64_t most = kMaxFree + kMaxPerByte * source_.bytes.size();
    require(counts.positions <= most && counts.indices <= 3 * most && counts.step >= 0);
    mesh_->memory =
        budget_->reserve(counts.positions * sizeof(Point) + counts.indices * 4, "Draco meshes");
    mesh_->positions.resize(counts.positions);
    mesh_->indices.resize(counts.indices);
    mesh_->step = counts.step;
    begun_ = true;
  }
  void require(bool condition) const {
    if (!condition) fail_broken(source_.path, "its decoder sent an invalid mesh");
  }

  const DracoSource& source_;
  MemoryBudget* budget_;
  DracoMesh* mesh_;
  bool begun_ = false;
  size_t filled_ = 0;  // bytes of both arrays
};

void send(const DracoMesh& mesh, const BlockSink& out) {
  const MeshReceiver::Counts counts = {mesh.positions.size(), mesh.indices.size(), mesh.step};
  out(std::as_bytes(std::span(&counts, 1)));
  out(std::as_bytes(std::span(mesh.positions)));
  out(std::as_bytes(std::span(mesh.indices)));
}

}  // namespace

bool has_draco() {
  return true;
}

DracoMesh decode_draco(const DracoSource& source, MemoryBudget* budget) {
  if (!source.sandbox) return decode_here(source, budget);
  DracoMesh mesh;
  MeshReceiver receiver(source, budget, &mesh);
  run_limited(
      decoder_limits(source.bytes.size(), *budget, true), source.path,
      [&](const BlockSink& out) { send(decode_here(source, budget), out); }, std::ref(receiver));
  receiver.finish();
  return mesh;
}

void read_draco(const File& file, const ReadOptions& options, const TriangleSink& sink) {
  if (!options.wants("")) return;
  const auto memory = options.budget->reserve(file.size(), "Draco files");
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  DracoSource source{bytes, file.path()};
  source.sandbox = options.sandbox;
  const DracoMesh mesh = decode_draco(source, options.budget);
  BatchWriter out(sink);
  out.quantisation(mesh.step);
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    out.add(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
            mesh.positions[mesh.indices[i + 2]]);
  }
  out.flush();
}

}  // namespace svdag
