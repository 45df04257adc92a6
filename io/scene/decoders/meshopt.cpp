#include "io/scene/decoders/meshopt.h"

#include <meshoptimizer.h>

#include <vector>

#include "io/scene/decoders/limited_decoder.h"
#include "io/scene/decoders/meshopt_vertices.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxRatio = 1024;
constexpr uint64_t kMaxFreeBytes = 65536;  // bytes, whatever the data

// The combinations that EXT_meshopt_compression allows.
bool is_allowed(const MeshoptView& v) {
  const bool indices = v.stride == 2 || v.stride == 4;
  const bool plain = v.filter.empty() || v.filter == "NONE";
  if (v.mode == "TRIANGLES") return plain && indices && v.count % 3 == 0;
  if (v.mode == "INDICES") return plain && indices;
  if (v.mode != "ATTRIBUTES" || v.stride == 0 || v.stride % 4 != 0 || v.stride > 256) return false;
  if (v.filter == "OCTAHEDRAL") return v.stride == 4 || v.stride == 8;
  if (v.filter == "QUATERNION") return v.stride == 8;
  return plain || v.filter == "EXPONENTIAL";
}

bool decode_view(const MeshoptView& v, std::span<const std::byte> bytes,
                 std::vector<std::byte>* out) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  out->resize(size_t(v.bytes()));
  if (v.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out->data(), v.count, v.stride, data, bytes.size()) == 0;
  if (v.mode == "INDICES")
    return meshopt_decodeIndexSequence(out->data(), v.count, v.stride, data, bytes.size()) == 0;
  if (is_meshopt_version_1(bytes)) {
    if (!decode_meshopt_vertices(bytes, v.stride, std::as_writable_bytes(std::span(*out))))
      return false;
  } else if (meshopt_decodeVertexBuffer(out->data(), v.count, v.stride, data, bytes.size()) != 0) {
    return false;
  }
  if (v.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out->data(), v.count, v.stride);
  if (v.filter == "QUATERNION") meshopt_decodeFilterQuat(out->data(), v.count, v.stride);
  if (v.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out->data(), v.count, v.stride);
  return true;
}

}  // namespace

bool has_meshopt() {
  return true;
}

void decode_meshopt(const MeshoptSource& source, const MeshoptView& view,
                    const MemoryBudget& budget, const BlockSink& out) {
  if (!is_allowed(view))
    fail_input(source.path, "has a buffer view whose EXT_meshopt_compression is not allowed");
  if (view.count > (kMaxFreeBytes + kMaxRatio * source.bytes.size()) / view.stride)
    fail_input(source.path, "has a compressed buffer view of " + std::to_string(view.count) +
                                " elements, more than its data can hold");
  uint64_t received = 0;
  run_decoder(
      decoder_limits(source.bytes.size(), budget), source.path, source.sandbox,
      [&](DecoderOutput& decoder) {
        std::vector<std::byte> decoded;
        if (!decode_view(view, source.bytes, &decoded))
          fail_input(source.path, "has broken EXT_meshopt_compression data");
        decoder.send(0, std::span<const std::byte>(decoded));
      },
      [&](const DecoderMessage& message) {
        received += message.bytes().size();
        if (received > view.bytes()) message.fail();
        out(message.bytes());
      });
  if (received != view.bytes()) fail_input(source.path, "its decoder sent too little");
}

}  // namespace svdag
