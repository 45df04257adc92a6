#include "io/scene/decoders/draco.h"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

#include "io/scene/decoders/limited_decoder.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Draco's working memory per triangle and its points, measured generously: corner table, faces,
// traversal state, and the portable and final values of all attributes.
constexpr uint64_t kDracoBytesPerElement = 256;

// Messages of the child: of each mesh in this order.
enum DracoMessage : uint64_t {
  kDracoStep,
  kDracoPositions,
  kDracoAttribute,
  kDracoIndices,
  kDracoEnd
};

[[noreturn]] void fail_broken(const std::string& path, const std::string& reason) {
  fail_input(path, "has broken Draco data: " + reason);
}

// --- In the child.

// `as_integers`: quantised positions remain the integers that they were stored as.
void decode_mesh(const DracoSource& source, const std::string& path, bool as_integers,
                 draco::Mesh* mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
  const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!type.ok()) fail_broken(path, type.status().error_msg_string());
  if (type.value() == draco::POINT_CLOUD)
    fail_input(path, "is a Draco point cloud, which has no triangles");
  draco::Decoder decoder;
  if (as_integers) decoder.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
  const draco::Status status = decoder.DecodeBufferToGeometry(&buffer, mesh);
  if (!status.ok()) fail_broken(path, status.error_msg_string());
}

// Sends c, or c / max if `normalized`; then, if `quantised`, minimum + that * step.
struct PositionForm {
  bool normalized = false;
  bool quantised = false;
  double step = 0;
  Point minimum = Point(0);
};

// The vertices: the values of the positions, or, `by_points`, the points of the mesh.
struct Vertices {
  uint32_t count = 0;
  bool by_points = false;
};

template <class Component>
double normalised(Component value) {
  if (!std::is_integral_v<Component>) return double(value);
  return std::max(double(value) / double(std::numeric_limits<Component>::max()), -1.0);
}

constexpr size_t kMaxComponents = 4;

// Calls visit(its components) for each vertex.
template <class Component, class Visit>
void visit_values_of(const draco::PointAttribute& attribute, const Vertices& vertices,
                     const std::string& path, const Visit& visit) {
  std::array<Component, kMaxComponents> v{};
  for (uint32_t i = 0; i < vertices.count; ++i) {
    const draco::AttributeValueIndex at = vertices.by_points
                                              ? attribute.mapped_index(draco::PointIndex(i))
                                              : draco::AttributeValueIndex(i);
    if (at.value() >= attribute.size()) fail_broken(path, "a point lacks a value");
    attribute.GetValue(at, v.data());
    visit(v);
  }
}

template <class Visit>
void visit_values(const draco::PointAttribute& attribute, const Vertices& vertices,
                  const std::string& path, const Visit& visit) {
  switch (attribute.data_type()) {
    case draco::DT_INT8:
      return visit_values_of<int8_t>(attribute, vertices, path, visit);
    case draco::DT_UINT8:
      return visit_values_of<uint8_t>(attribute, vertices, path, visit);
    case draco::DT_INT16:
      return visit_values_of<int16_t>(attribute, vertices, path, visit);
    case draco::DT_UINT16:
      return visit_values_of<uint16_t>(attribute, vertices, path, visit);
    case draco::DT_INT32:
      return visit_values_of<int32_t>(attribute, vertices, path, visit);
    case draco::DT_UINT32:
      return visit_values_of<uint32_t>(attribute, vertices, path, visit);
    case draco::DT_FLOAT32:
      return visit_values_of<float>(attribute, vertices, path, visit);
    case draco::DT_FLOAT64:
      return visit_values_of<double>(attribute, vertices, path, visit);
    default:
      fail_broken(path, "values are of an unknown type");
  }
}

void send_positions(const draco::PointAttribute& attribute, const Vertices& vertices,
                    const PositionForm& form, const std::string& path, DecoderOutput* out) {
  std::vector<Point> batch;
  const auto send = [&] {
    if (!batch.empty()) out->send(kDracoPositions, std::span<const Point>(batch));
    batch.clear();
  };
  visit_values(attribute, vertices, path, [&](const auto& v) {
    Point p;
    for (int c = 0; c < 3; ++c) {
      const double value = form.normalized ? normalised(v[size_t(c)]) : double(v[size_t(c)]);
      p[c] = form.quantised ? form.minimum[c] + value * form.step : value;
    }
    batch.push_back(p);
    if (batch.size() == 4096) send();
  });
  send();
}

void send_attribute(const draco::Mesh& mesh, const DracoAttribute& wanted, const Vertices& vertices,
                    const std::string& path, DecoderOutput* out) {
  const draco::PointAttribute* attribute =
      mesh.GetAttributeByUniqueId(uint32_t(std::min<uint64_t>(wanted.id, UINT32_MAX)));
  if (attribute == nullptr || uint64_t(attribute->num_components()) != wanted.components ||
      wanted.components > kMaxComponents)
    fail_broken(path, "it has no attribute " + std::to_string(wanted.id) + " of " +
                          std::to_string(wanted.components) + " components");
  std::vector<double> batch;
  const auto send = [&] {
    if (!batch.empty()) out->send(kDracoAttribute, std::span<const double>(batch));
    batch.clear();
  };
  visit_values(*attribute, vertices, path, [&](const auto& v) {
    for (size_t c = 0; c < wanted.components; ++c) batch.push_back(normalised(v[c]));
    if (batch.size() >= 4096) send();
  });
  send();
}

PositionForm form_of(const draco::PointAttribute& attribute, const DracoSource& source,
                     const std::string& path) {
  const auto* data = attribute.GetAttributeTransformData();
  if (data == nullptr || data->transform_type() != draco::ATTRIBUTE_QUANTIZATION_TRANSFORM)
    return {source.normalized || attribute.normalized()};
  draco::AttributeQuantizationTransform transform;
  if (!transform.InitFromAttribute(attribute) || transform.quantization_bits() < 1 ||
      transform.quantization_bits() > 31 || transform.min_values().size() < 3 ||
      !(transform.range() >= 0))
    fail_broken(path, "positions have no valid quantisation");
  const double steps = double((1u << transform.quantization_bits()) - 1);
  return {attribute.normalized(),
          true,
          double(transform.range()) / steps,
          {transform.min_value(0), transform.min_value(1), transform.min_value(2)}};
}

const draco::PointAttribute& positions_of(const draco::Mesh& mesh, const DracoSource& source,
                                          const std::string& path) {
  const draco::PointAttribute* attribute =
      source.position_id ? mesh.GetAttributeByUniqueId(
                               uint32_t(std::min<uint64_t>(*source.position_id, UINT32_MAX)))
                         : mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (attribute == nullptr || attribute->num_components() != 3)
    fail_broken(path, "it has no three-dimensional positions");
  return *attribute;
}

void send_mesh(const draco::Mesh& mesh, const DracoSource& source, const std::string& path,
               DecoderOutput* out) {
  const draco::PointAttribute* attribute = &positions_of(mesh, source, path);
  const PositionForm form = form_of(*attribute, source, path);
  const bool by_points = !source.attributes.empty();
  const Vertices vertices{by_points ? mesh.num_points() : uint32_t(attribute->size()), by_points};
  out->send_one(kDracoStep, form.step);
  send_positions(*attribute, vertices, form, path, out);
  for (const DracoAttribute& each : source.attributes)
    send_attribute(mesh, each, vertices, path, out);
  std::vector<uint32_t> indices;
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(f))) {
      const uint32_t value = point >= mesh.num_points() ? UINT32_MAX
                             : by_points                ? point.value()
                                                        : attribute->mapped_index(point).value();
      if (value >= vertices.count) fail_broken(path, "a triangle has no such vertex");
      indices.push_back(value);
    }
    if (indices.size() >= 3 * 8192 || f + 1 == mesh.num_faces()) {
      out->send(kDracoIndices, std::span<const uint32_t>(indices));
      indices.clear();
    }
  }
  out->send(kDracoEnd, std::span<const char>());
}

// --- In the parent.

// Passes the messages on, up to what the bytes of their source can hold.
class DracoMessages {
 public:
  DracoMessages(std::span<const DracoSource> sources, const DracoReceiver& receiver)
      : sources_(sources), receiver_(receiver) {}

  // Number of meshes that arrived whole.
  size_t done() const { return done_; }

  void receive(const DecoderMessage& message) {
    if (done_ == sources_.size()) message.fail();
    const uint64_t max_elements = max_draco_elements(sources_[done_].bytes.size());
    if (message.kind() == kDracoStep && !begun_) {
      const double step = message.record<double>();
      if (!(step >= 0)) message.fail();
      positions_ = values_ = indices_ = 0;
      begun_ = true;
      return receiver_.begin(done_, step);
    }
    if (!begun_) message.fail();
    if (message.kind() == kDracoPositions && values_ == 0 && indices_ == 0) {
      const auto positions = message.records<Point>();
      positions_ += positions.size();
      if (positions_ > max_elements) message.fail();
      receiver_.positions(positions);
    } else if (message.kind() == kDracoAttribute && indices_ == 0) {
      const auto values = message.records<double>();
      values_ += values.size();
      if (values_ > max_values()) message.fail();
      receiver_.attributes(values);
    } else if (message.kind() == kDracoIndices && values_ == max_values()) {
      const auto indices = message.records<uint32_t>();
      indices_ += indices.size();
      if (indices_ > 3 * max_elements || indices.size() % 3 != 0) message.fail();
      receiver_.indices(indices);
    } else if (message.kind() == kDracoEnd && values_ == max_values()) {
      ++done_;
      begun_ = false;
    } else {
      message.fail();
    }
  }

 private:
  // Of all attributes.
  uint64_t max_values() const {
    uint64_t values = 0;
    for (const DracoAttribute& each : sources_[done_].attributes)
      values += each.components * positions_;
    return values;
  }

  std::span<const DracoSource> sources_;
  const DracoReceiver& receiver_;
  size_t done_ = 0;
  bool begun_ = false;
  uint64_t positions_ = 0, values_ = 0, indices_ = 0;  // of the mesh that is arriving
};

}  // namespace

bool has_draco() {
  return true;
}

size_t decode_draco(std::span<const DracoSource> sources, const std::string& path,
                    const MemoryBudget& budget, bool sandbox, const DracoReceiver& receiver) {
  uint64_t bytes = 0, largest = 0;
  for (const DracoSource& each : sources) {
    bytes += each.bytes.size();
    largest = std::max<uint64_t>(largest, each.bytes.size());
  }
  const DecoderLimits limits =
      decoder_limits(bytes, budget, kDracoBytesPerElement * max_draco_elements(largest));
  DracoMessages messages(sources, receiver);
  try {
    run_decoder(
        limits, path, sandbox,
        [&](DecoderOutput& out) {
          for (const DracoSource& each : sources) {
            auto mesh = std::make_unique<draco::Mesh>();
            decode_mesh(each, path, true, mesh.get());
            // As an integer of 32 bits, a normalised position has lost its type, which scales it.
            const PositionForm form = form_of(positions_of(*mesh, each, path), each, path);
            if (form.normalized && !form.quantised) {
              mesh = std::make_unique<draco::Mesh>();
              decode_mesh(each, path, false, mesh.get());
            }
            send_mesh(*mesh, each, path, &out);
          }
        },
        [&](const DecoderMessage& message) { messages.receive(message); });
  } catch (const Error& error) {
    const bool refused = error.code() == ExitCode::kBadInput || error.code() == ExitCode::kMemory;
    if (!refused || (messages.done() == 0 && sources.size() == 1)) throw;
    // A later source may be to blame.
    if (messages.done() == 0)
      return decode_draco(sources.first(1), path, budget, sandbox, receiver);
  }
  return messages.done();
}

}  // namespace svdag
