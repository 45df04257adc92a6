// What all writers of surfaces share: the limit of quads, and a place for what is written at the
// end.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "io/formats/output.h"
#include "io/formats/surfaces/surface_files.h"
#include "streaming/file/file.h"

namespace svdag {

// Passes the tiles to write() until there are too many quads, and then fails with their number.
SurfaceCounts stream_surface(const VoxelWindow& window, const SurfaceFileConfig& config,
                             const SurfaceSink& write);

// The position of a vertex in the world.
inline Point world_of(const Grid& grid, const SurfaceTile::Vertex& vertex) {
  const Point corner = grid.corner();
  Point p;
  for (int a = 0; a < 3; ++a) p[a] = corner[a] + double(vertex.at[size_t(a)]) * grid.voxel_size;
  return p;
}

[[noreturn]] void fail_too_large(const std::string& path, const char* limit);

// Bytes for the end of an output.
class LaterBytes {
 public:
  explicit LaterBytes(const std::string& output)
      : file_(File::create_anonymous(folder_of(output), output)) {}

  template <class T>
  void put(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    if (buffer_.size() >= kBuffer) flush();
  }
  uint64_t size() const { return written_ + buffer_.size(); }
  void append_to(Output* out);

 private:
  static constexpr size_t kBuffer = size_t(1) << 20;
  void flush();

  File file_;
  std::vector<std::byte> buffer_;
  uint64_t written_ = 0;
};

}  // namespace svdag
