// A small read window over a foreign DAG file, for access to its nodes by file offset.
//
// An import reads the nodes of a level in ascending order (io/dag/graph/node_graph.h), so the
// window moves forward; other orders work too, but slower.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "io/grid.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {

class GraphWindow {
 public:
  // `file` must outlive this.
  explicit GraphWindow(const File& file)
      : file_(&file), bytes_(size_t(std::min<uint64_t>(kWindow, file.size()))) {}

  const std::string& path() const { return file_->path(); }
  uint32_t u32(uint64_t offset) { return at<uint32_t>(offset); }
  uint64_t u64(uint64_t offset) { return at<uint64_t>(offset); }

 private:
  static constexpr size_t kWindow = size_t(1) << 16;

  template <class T>
  T at(uint64_t offset) {
    if (offset < begin_ || offset + sizeof(T) > begin_ + filled_) fill(offset, sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + (offset - begin_), sizeof value);
    return value;
  }
  void fill(uint64_t offset, size_t min_bytes) {
    begin_ = offset;
    filled_ = file_->read_some_at(offset, bytes_);
    if (filled_ < min_bytes) fail_input(path(), "unexpected end of file", offset + filled_);
  }

  const File* file_;
  std::vector<std::byte> bytes_;
  uint64_t begin_ = 0;
  size_t filled_ = 0;
};

// Reads the next number of a header.
template <class T>
T header_value(ByteStream* stream) {
  T value;
  stream->read(std::as_writable_bytes(std::span(&value, 1)));
  return value;
}

// Checks log2 N of a foreign file, read from the field at `offset`.
inline int checked_levels(const File& file, uint64_t levels, uint64_t offset) {
  if (levels < uint64_t(kMinLevels) || levels > uint64_t(kMaxLevels))
    fail_input(file.path(), "has " + std::to_string(levels) + " levels, 3 to 20 are supported",
               offset);
  return int(levels);
}

// The grid whose cube begins at `min` and has the longest side of the box.
inline Grid grid_of_box(const File& file, const Point& min, const Point& max, int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = min;
  double side = 0;
  for (int a = 0; a < 3; ++a) {
    side = std::max(side, max[a] - min[a]);
    if (!std::isfinite(min[a]) || !std::isfinite(max[a])) side = NAN;
  }
  grid.voxel_size = std::ldexp(side, -levels);
  if (!std::isnormal(grid.voxel_size) || grid.voxel_size < 0)
    fail_input(file.path(), "its bounding box is empty or not finite", 0);
  grid.selection = grid.whole();
  return grid;
}

}  // namespace svdag
