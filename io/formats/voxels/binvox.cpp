#include "io/formats/voxels/binvox.h"

#include <cmath>
#include <cstdio>

#include "io/formats/output.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

class RunWriter {
 public:
  explicit RunWriter(Output* out) : out_(out) {}
  void add(bool value, uint64_t count) {
    if (value != value_) {
      put();
      value_ = value;
    }
    count_ += count;
  }
  void finish() { put(); }

 private:
  void put() {
    while (count_ > 0) {
      const uint8_t n = uint8_t(std::min<uint64_t>(count_, 255));
      out_->put(uint8_t(value_));
      out_->put(n);
      count_ -= n;
    }
  }

  Output* out_;
  bool value_ = false;
  uint64_t count_ = 0;
};

// Some layers of the cube along x: one bit per voxel, y fastest.
class Layers {
 public:
  Layers(int64_t depth, int64_t side)
      : side_(side), row_((side + 63) / 64), words_(size_t(depth * side * row_)) {}
  void clear() { std::fill(words_.begin(), words_.end(), 0); }
  void set(int64_t x, int64_t y, int64_t z) {
    words_[size_t((x * side_ + z) * row_ + y / 64)] |= uint64_t(1) << (y % 64);
  }
  void put(int64_t x, RunWriter* runs) const {
    for (int64_t row = x * side_; row < (x + 1) * side_; ++row) {
      for (int64_t w = 0, left = side_; w < row_; ++w, left -= 64)
        put_word(words_[size_t(row * row_ + w)], int(std::min<int64_t>(left, 64)), runs);
    }
  }

 private:
  static void put_word(uint64_t word, int bits, RunWriter* runs) {
    while (bits > 0) {
      const bool value = (word & 1) != 0;
      const int n = std::min(std::countr_zero(value ? ~word : word), bits);
      runs->add(value, uint64_t(n));
      bits -= n;
      word = n == 64 ? 0 : word >> n;
    }
  }

  int64_t side_, row_;
  std::vector<uint64_t> words_;
};

struct VoxelCounts {
  uint64_t x, y, z;  // voxels per axis
};

// Lines with other keywords are comments of the program that wrote the file.
bool is_header_keyword(const std::string& line) {
  for (const char* word : {"dim", "translate", "scale", "data"}) {
    if (line.starts_with(word)) return true;
  }
  return false;
}

// Reads the header lines; sets *data to the offset of the data.
VoxelCounts read_header(const File& file, GridPlacement* place, uint64_t* data) {
  ByteStream stream(file, 0, UINT64_MAX, 4096);
  const auto first = stream.line(4096);
  if (!first || !first->starts_with("#binvox"))
    fail_input(file.path(), "is not a binvox file (it does not begin with #binvox)");
  VoxelCounts dim{};
  double scale = 1;
  for (;;) {
    const uint64_t at = stream.offset();
    const auto view = stream.line(4096);
    if (!view) fail_input(file.path(), "has no data", at);
    const std::string line(*view);
    unsigned long long d, h, w;
    double x, y, z;
    if (line == "data") break;
    if (std::sscanf(line.c_str(), "dim %llu %llu %llu", &d, &h, &w) == 3) {
      dim = {d, w, h};  // of x, y, z: the file stores x slowest, then z, then y
    } else if (std::sscanf(line.c_str(), "translate %lf %lf %lf", &x, &y, &z) == 3) {
      place->corner = {x, y, z};
    } else if (std::sscanf(line.c_str(), "scale %lf", &scale) != 1 && is_header_keyword(line)) {
      fail_input(file.path(), "has an invalid header line", at);
    }
  }
  for (const uint64_t side : {dim.x, dim.y, dim.z}) {
    if (side == 0 || side > uint64_t(1) << kMaxLevels)
      fail_input(file.path(), "its dimensions are not 1 to 1M voxels per axis");
    place->resolution = std::max(place->resolution, side);
  }
  place->voxel_size = scale / double(place->resolution);
  *data = stream.offset();
  return dim;
}

}  // namespace

void write_binvox(const VoxelWindow& window, const std::string& path) {
  const VoxelBox& box = window.box();
  int64_t side = 1;
  for (int a = 0; a < 3; ++a) side = std::max(side, box.max[a] - box.min[a]);
  if (side > kMaxBinvoxSide)
    fail_usage("binvox stores every voxel, set or not: a window has at most " +
               format_count(kMaxBinvoxSide) + " voxels per axis, this one has " +
               format_count(uint64_t(side)) +
               ": export a coarser --level, or a part with --bounds");
  Output out(path);
  const std::string dim = std::to_string(side);
  const Point corner = window.grid.corner() + window.grid.voxel_size * Point(box.min);
  out.put("#binvox 1\ndim " + dim + " " + dim + " " + dim + "\ntranslate " +
          format_double(corner.x) + " " + format_double(corner.y) + " " + format_double(corner.z) +
          "\nscale " + format_double(window.grid.voxel_size * double(side)) + "\ndata\n");
  RunWriter runs(&out);
  Layers layers(kBlockSide, side);
  uint64_t written = 0;
  for (int64_t x = 0; x < side; x += kBlockSide) {
    layers.clear();
    const VoxelBox slab = {box.min + LatticePoint(x, 0, 0),
                           {std::min(box.min.x + x + kBlockSide, box.max.x), box.max.y, box.max.z}};
    written += for_each_voxel(window.walk, slab, [&](const Voxel& v) {
      layers.set(v[0] - slab.min.x, v[1] - slab.min.y, v[2] - slab.min.z);
    });
    for (int64_t i = 0; i < std::min<int64_t>(kBlockSide, side - x); ++i) layers.put(i, &runs);
  }
  SVDAG_ASSERT(written == window.voxels);
  runs.finish();
  out.commit();
}

GridPlacement read_binvox(const File& file, const VoxelSink& sink) {
  GridPlacement place;
  uint64_t data = 0;
  const VoxelCounts dim = read_header(file, &place, &data);
  ByteStream stream(file, data);
  VoxelBatch batch(sink);
  const uint64_t total = dim.x * dim.y * dim.z;
  for (uint64_t i = 0; i < total;) {
    std::array<uint8_t, 2> run;
    stream.read(std::as_writable_bytes(std::span(run)));
    if (run[0] > 1 || run[1] == 0 || run[1] > total - i)
      fail_input(file.path(), "damaged file: a run has an invalid value or length",
                 stream.offset() - 2);
    for (const uint64_t end = i + run[1]; i < end; ++i) {
      if (run[0] != 0)
        batch.add({uint32_t(i / dim.y / dim.z), uint32_t(i % dim.y), uint32_t(i / dim.y % dim.z)});
    }
  }
  batch.flush();
  return place;
}

}  // namespace svdag
