#include "io/formats/voxels/npz.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "io/formats/voxels/npy_array.h"
#include "io/formats/voxels/npz_layers.h"
#include "io/formats/voxels/zip.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"
#include "streaming/spill/work_array.h"

namespace svdag {
namespace {

bool is_coordinates(const NpyArray& a) {
  return is_integer(a) && a.shape.size() == 2 && a.shape[1] == 3;
}
bool is_colours(const NpyArray& a) {
  return a.kind == 'u' && a.bytes == 1 && a.shape.size() == 2 && a.shape[1] == 3;
}
bool is_dense(const NpyArray& a) {
  return (a.kind == 'b' || a.kind == 'u') && a.bytes == 1 && a.shape.size() == 3;
}

// A colour of each row, in either order of the array.
class NpzColours {
 public:
  NpzColours(const File& file, const NpyArray& array) {
    const uint64_t column = array.fortran_order ? array.shape[0] : 0;
    for (uint64_t c = 0; c < (array.fortran_order ? 3 : 1); ++c)
      streams_.emplace_back(file, array.offset + c * column, array.end);
  }
  Colour next() {
    std::array<uint8_t, 3> rgb;
    for (size_t c = 0; c < 3; ++c)
      streams_[streams_.size() == 1 ? 0 : c].read(
          std::as_writable_bytes(std::span(rgb).subspan(c, 1)));
    return {rgb[0], rgb[1], rgb[2]};
  }

 private:
  std::vector<ByteStream> streams_;
};

// In Fortran order, which numpy.argwhere() gives, all x precede all y and all z: one stream per
// axis.
void read_coordinates(const File& file, const NpyArray& array, NpzLabels* labels,
                      NpzColours* colours, const VoxelSink& sink) {
  const uint64_t column = array.fortran_order ? array.shape[0] * array.bytes : 0;
  std::vector<ByteStream> streams;
  for (uint64_t a = 0; a < (array.fortran_order ? 3 : 1); ++a)
    streams.emplace_back(file, array.offset + a * column, array.end);
  VoxelBatch batch(sink);
  for (uint64_t row = 0; row < array.shape[0]; ++row) {
    Voxel voxel;
    for (size_t a = 0; a < 3; ++a) {
      ByteStream& stream = streams[array.fortran_order ? a : 0];
      const uint64_t value = read_integer(&stream, array);
      if (value >> kMaxLevels != 0)
        fail_input(file.path(), "a coordinate is not 0 ... 1M - 1", stream.offset() - array.bytes);
      voxel[a] = uint32_t(value);
    }
    batch.add(voxel);
    if (labels != nullptr) batch.add_label(labels->next());
    if (colours != nullptr) batch.add_colour(colours->next());
  }
  batch.flush();
}

void read_dense(const File& file, const NpyArray& array, const VoxelSink& sink) {
  for (const uint64_t side : array.shape) {
    if (side > uint64_t(1) << kMaxLevels)
      fail_input(file.path(), "has more than 1M voxels on an axis", array.offset);
  }
  if (array.elements() == 0) return;
  ByteStream stream(file, array.offset, array.end);
  VoxelBatch batch(sink);
  // Axes from the slowest to the fastest.
  const std::array<size_t, 3> axes =
      array.fortran_order ? std::array<size_t, 3>{2, 1, 0} : std::array<size_t, 3>{0, 1, 2};
  Voxel v{};
  for (v[axes[0]] = 0; v[axes[0]] < array.shape[axes[0]]; ++v[axes[0]])
    for (v[axes[1]] = 0; v[axes[1]] < array.shape[axes[1]]; ++v[axes[1]]) {
      for (uint64_t done = 0, side = array.shape[axes[2]]; done < side;) {
        const auto bytes = stream.peek();
        const uint64_t n = std::min<uint64_t>(bytes.size(), side - done);
        for (uint64_t i = 0; i < n; ++i) {
          if (bytes[i] == std::byte(0)) continue;
          v[axes[2]] = uint32_t(done + i);
          batch.add(v);
        }
        stream.skip(n);
        done += n;
      }
    }
  batch.flush();
}

// Reads the next number of an array of integers or floats.
double read_number(ByteStream* stream, const NpyArray& array) {
  const uint64_t bits = read_integer(stream, array);
  if (array.kind == 'f' && array.bytes == 4) return double(std::bit_cast<float>(uint32_t(bits)));
  if (array.kind == 'f') return std::bit_cast<double>(bits);
  return array.kind == 'i' ? double(int64_t(bits)) : double(bits);
}

bool is_placement(std::string_view name) {
  return name == "corner" || name == "resolution" || name == "voxel_size";
}

// Reads an array that places the voxels. Such an array is read or rejected, never ignored.
void read_placement(const File& file, std::string_view name, const NpyArray& array,
                    GridPlacement* place) {
  const uint64_t count = name == "corner" ? 3 : 1;
  if (!is_placement(name)) return;
  const bool is_float = array.kind == 'f' && (array.bytes == 4 || array.bytes == 8);
  if (!(is_float || is_integer(array)) || array.elements() != count)
    fail_input(file.path(), "has an array \"" + std::string(name) + "\" that is not " +
                                (count == 3 ? "three numbers" : "one number") +
                                " (float32, float64 or integer)");
  ByteStream stream(file, array.offset, array.end);
  if (name == "corner") {
    for (int a = 0; a < 3; ++a) place->corner[a] = read_number(&stream, array);
  } else if (name == "voxel_size") {
    place->voxel_size = read_number(&stream, array);
  } else {
    const double n = read_number(&stream, array);
    if (!(n >= 1 && n <= 0x1p20 && n == std::floor(n)))
      fail_input(file.path(), "has a resolution that is not 1 ... 1M", array.offset);
    place->resolution = uint64_t(n);
  }
}

// Chooses the array of a file that holds its voxels.
class VoxelArrayChoice {
 public:
  explicit VoxelArrayChoice(const File& file) : file_(file) {}

  void consider(std::string_view name, const NpyArray& array) {
    if (is_placement(name)) return;
    const bool fits = is_coordinates(array) || is_dense(array);
    if (name == kCoordinates) {
      if (!fits)
        fail_input(file_.path(), "has an array \"coordinates\" that is not N x 3 integers");
      named_ = array;
    } else if (fits) {
      if (found_) several_ = true;
      found_ = array;
    } else if (unread_.empty()) {
      if (array.kind == 0 || is_text(array)) unread_ = name;
      if (array.kind == 'f' && array.shape.size() == 2 && array.shape[1] == 3) points_ = name;
    }
  }

  // The array named "coordinates", else the only candidate.
  const NpyArray& voxels() const {
    if (named_) return *named_;
    if (several_)
      fail_input(file_.path(),
                 "has more than one array that may hold the voxels: name theirs \"coordinates\"");
    if (!found_)
      fail_input(file_.path(),
                 "has no array of N x 3 integers and no 3-dimensional array of bool" +
                     (unread_.empty() ? "" : "; of an unsupported type: " + unread_.substr(0, 40)));
    if (!points_.empty() && is_coordinates(*found_))
      fail_input(file_.path(), "has N x 3 floats, " + points_.substr(0, 40) +
                                   ", beside N x 3 integers, which may be colours: name the array "
                                   "of voxels \"coordinates\"");
    return *found_;
  }

 private:
  static constexpr std::string_view kCoordinates = "coordinates";

  const File& file_;
  std::optional<NpyArray> named_, found_;
  bool several_ = false;
  std::string points_;
  std::string unread_;  // the first array of an unsupported type
};

void put_colours(const VoxelWindow& window, ZipWriter* zip) {
  begin_array(zip, "colours", "|u1", "(" + std::to_string(window.voxels) + ", 3)");
  for_each_voxel(window.walk, window.box(), [&](const Voxel& voxel) {
    const Colour colour = window.colours->of(voxel);
    for (const uint8_t channel : {colour.r, colour.g, colour.b}) zip->put(channel);
  });
  zip->end();
}

void put_labels(const VoxelWindow& window, ZipWriter* zip) {
  begin_array(zip, "label", "<u2", "(" + std::to_string(window.voxels) + ",)");
  for_each_voxel(window.walk, window.box(),
                 [&](const Voxel& voxel) { zip->put(uint16_t(window.labels->of(voxel))); });
  zip->end();
  const std::vector<Layer>& layers = window.labels->layers();
  begin_array(zip, "layer_colours", "<u4", "(" + std::to_string(layers.size()) + ",)");
  for (const Layer& layer : layers) {
    const Colour& colour = layer.colour;
    zip->put(uint32_t(colour.r) << 16 | uint32_t(colour.g) << 8 | colour.b);
  }
  zip->end();
  std::string names;
  for (const Layer& layer : layers) names += layer.name + '\0';
  begin_array(zip, "layer_names", "|u1", "(" + std::to_string(names.size()) + ",)");
  zip->put(names);
  zip->end();
  const std::string kind = layer_kind_name(window.labels->kind()) + std::string(1, '\0');
  begin_array(zip, "layer_kind", "|u1", "(" + std::to_string(kind.size()) + ",)");
  zip->put(kind);
  zip->end();
}

}  // namespace

void write_npz(const VoxelWindow& window, const std::string& path) {
  ZipWriter zip(path);
  begin_array(&zip, "coordinates", "<i4", "(" + std::to_string(window.voxels) + ", 3)");
  const uint64_t written = for_each_voxel(window.walk, window.box(), [&](const Voxel& voxel) {
    zip.put(std::as_bytes(std::span(voxel)));
  });
  SVDAG_ASSERT(written == window.voxels);
  zip.end();
  begin_array(&zip, "resolution", "<i8", "()");
  zip.put(window.grid.resolution());
  zip.end();
  put_placement(&zip, window.grid.corner(), window.grid.voxel_size);
  if (window.colours != nullptr && window.colours->are_stored()) put_colours(window, &zip);
  if (window.labels != nullptr) put_labels(window, &zip);
  zip.commit();
}

GridPlacement read_npz(const File& archive, const VoxelSink& sink, LayerTable* layers,
                       bool with_colours) {
  std::vector<ZipEntry> entries;
  std::array<char, 6> start{};
  archive.read_some_at(0, std::as_writable_bytes(std::span(start)));
  const bool zipped = std::string_view(start.data(), 6) != kNpyMagic;
  if (zipped) {
    entries = read_zip(archive);
    std::erase_if(entries, [](const ZipEntry& entry) { return !entry.name.ends_with(".npy"); });
  } else {
    entries.push_back({"array.npy", 0, archive.size(), 0, 0, false});
  }
  std::optional<File> inflated;
  if (std::ranges::any_of(entries, &ZipEntry::is_deflated))
    inflated = inflate_entries(archive, temporary_room(nullptr).folder, &entries);
  const File& file = inflated ? *inflated : archive;
  GridPlacement place;
  VoxelArrayChoice choice(file);
  NpzLayerArrays layer_arrays;
  std::optional<NpyArray> colour_array;
  for (const ZipEntry& entry : entries) {
    const NpyArray array = read_npy_header(file, entry.offset, entry.offset + entry.bytes);
    const std::string_view name(entry.name.data(), entry.name.size() - 4);  // without .npy
    read_placement(file, name, array, &place);
    choice.consider(name, array);
    layer_arrays.consider(name, array);
    if (name == "colours" && is_colours(array)) colour_array = array;
  }
  const NpyArray& voxels = choice.voxels();
  if (is_dense(voxels)) {
    for (const uint64_t side : voxels.shape) place.resolution = std::max(place.resolution, side);
    read_dense(file, voxels, sink);
  } else {
    std::optional<NpzLabels> labels;
    std::optional<NpzColours> colours;
    if (layers != nullptr && layer_arrays.label && layer_arrays.label->offset != voxels.offset)
      labels.emplace(read_npz_layers(file, layer_arrays, voxels.shape[0], layers));
    if (with_colours && colour_array && colour_array->offset != voxels.offset) {
      if (colour_array->shape[0] != voxels.shape[0])
        fail_input(file.path(),
                   "has an array \"colours\" that is not a colour for each row of \"coordinates\" "
                   "(--no-colours ignores it)");
      colours.emplace(file, *colour_array);
    }
    read_coordinates(file, voxels, labels ? &*labels : nullptr, colours ? &*colours : nullptr,
                     sink);
  }
  for (const ZipEntry& entry : entries) {
    if (zipped) check_crc(file, entry);
  }
  return place;
}

}  // namespace svdag
