// Draco files: one mesh, decoded as a whole.
#include <algorithm>
#include <vector>

#include "io/scene/decoders/draco.h"
#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"

namespace svdag {

LeftOut read_draco(const File& file, const ReadOptions& options, MeshWriter* out) {
  if (!options.wants("")) return {};
  const auto memory = options.budget->reserve(file.size(), "Draco files");
  std::vector<std::byte> bytes(size_t(file.size()));
  file.read_at(0, bytes);
  const DracoReceiver receiver = {
      [&](size_t, double step) {
        out->begin(MeshWriter::Precision::kDouble, max_draco_elements(bytes.size()));
        out->quantisation(step);
      },
      [&](std::span<const Point> positions) {
        for (const Point& p : positions) out->vertex(p);
      },
      [&](std::span<const uint32_t> indices) {
        if (std::ranges::any_of(indices, [&](uint32_t i) { return i >= out->vertices(); }))
          fail_input(file.path(), "has broken Draco data: a triangle has no such vertex");
        for (size_t i = 0; i < indices.size(); i += 3)
          out->triangle(indices[i], indices[i + 1], indices[i + 2]);
      }};
  const DracoSource source{bytes};
  decode_draco({&source, 1}, file.path(), *options.budget, options.sandbox, receiver);
  return {};
}

}  // namespace svdag
