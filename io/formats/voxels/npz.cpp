#include "io/formats/voxels/npz.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "io/formats/label_numbers.h"
#include "io/formats/voxels/zip.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

constexpr std::string_view kArrayMagic = "\x93NUMPY";

// Begins an archive entry: an array of this type and shape, in NumPy's notation.
void begin_array(ZipWriter* zip, const std::string& name, const std::string& type,
                 const std::string& shape) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  constexpr size_t kPrefixBytes = 10;  // magic, version, length
  header.resize((kPrefixBytes + header.size() + 1 + 63) / 64 * 64 - kPrefixBytes - 1, ' ');
  header += '\n';
  zip->begin(name + ".npy");
  zip->put(kArrayMagic);
  zip->put(uint8_t(1));
  zip->put(uint8_t(0));
  zip->put(uint16_t(header.size()));
  zip->put(header);
}

// An array in a file: its type, its shape and the offsets of its elements.
struct Array {
  char kind = 0;       // 'b' bool, 'u', 'i', 'f'; 0: unsupported type, other members are unset
  uint64_t bytes = 0;  // of an element
  bool fortran_order = false;
  std::vector<uint64_t> shape;
  uint64_t offset = 0, end = 0;

  uint64_t elements() const {
    uint64_t n = 1;
    for (const uint64_t side : shape) n *= side;
    return n;
  }
};

// The text after `key` in a header, which is a Python dictionary as NumPy writes it.
std::string_view header_value(std::string_view header, std::string_view key, const File& file,
                              uint64_t offset) {
  const size_t at = header.find(key);
  const size_t colon = at == std::string_view::npos ? at : header.find(':', at);
  if (colon == std::string_view::npos)
    fail_input(file.path(), "damaged .npy header: no " + std::string(key), offset);
  header.remove_prefix(colon + 1);
  header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
  return header;
}

std::vector<uint64_t> parse_shape(std::string_view text, const File& file, uint64_t offset) {
  std::vector<uint64_t> shape;
  const auto bad = [&] { fail_input(file.path(), "damaged .npy header: bad shape", offset); };
  if (text.empty() || text[0] != '(') bad();
  unsigned __int128 product = 1;
  for (text.remove_prefix(1); !text.empty() && text[0] != ')';) {
    uint64_t side = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (error != std::errc() || shape.size() == 8) bad();
    shape.push_back(side);
    product *= side;
    if (product >> 62 != 0) bad();
    text.remove_prefix(size_t(end - text.data()));
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
  }
  return shape;
}

Array read_header(const File& file, uint64_t offset, uint64_t end) {
  ByteStream stream(file, offset, end);
  std::array<char, 8> start{};
  if (stream.remaining() < 12) fail_input(file.path(), "is not a .npy array", offset);
  stream.read(std::as_writable_bytes(std::span(start)));
  if (std::string_view(start.data(), 6) != kArrayMagic || start[6] < 1 || start[6] > 3)
    fail_input(file.path(), "is not a .npy array", offset);
  uint32_t length = 0;
  stream.read(std::as_writable_bytes(std::span(&length, 1)).first(start[6] == 1 ? 2 : 4));
  if (length > 65536 || length > stream.remaining())
    fail_input(file.path(), "damaged .npy header: impossible length", offset);
  std::string header(length, '\0');
  stream.read(std::as_writable_bytes(std::span(header)));
  Array array;
  const std::string_view type = header_value(header, "'descr'", file, offset);
  if (type.size() < 5 || (type[1] != '<' && type[1] != '|') || type[3] < '1' || type[3] > '8' ||
      type[4] != type[0])
    return array;
  array.kind = type[2];
  array.bytes = uint64_t(type[3] - '0');
  array.fortran_order = header_value(header, "'fortran_order'", file, offset).starts_with("True");
  array.shape = parse_shape(header_value(header, "'shape'", file, offset), file, offset);
  array.offset = stream.offset();
  array.end = end;
  if (array.elements() > (end - array.offset) / array.bytes)
    fail_input(file.path(), "has an array that is larger than the file", offset);
  return array;
}

bool is_integer(const Array& a) {
  const bool size = a.bytes == 1 || a.bytes == 2 || a.bytes == 4 || a.bytes == 8;
  return (a.kind == 'i' || a.kind == 'u') && size;
}
bool is_coordinates(const Array& a) {
  return is_integer(a) && a.shape.size() == 2 && a.shape[1] == 3;
}
bool is_dense(const Array& a) {
  return (a.kind == 'b' || a.kind == 'u') && a.bytes == 1 && a.shape.size() == 3;
}

// Reads the next integer of the array; a negative one of any width becomes a large number.
uint64_t read_integer(ByteStream* stream, const Array& array) {
  uint64_t bits = 0;
  stream->read(std::as_writable_bytes(std::span(&bits, 1)).first(array.bytes));
  const int unused = 64 - 8 * int(array.bytes);
  return array.kind == 'i' ? uint64_t(int64_t(bits << unused) >> unused) : bits;
}

// The labels of voxels, row by row.
class Labels {
 public:
  // `array`: as many integers as there are voxels. `count`: of the layers, by number; none: each
  // integer is a layer of `table`.
  Labels(const File& file, const Array& array, std::optional<size_t> count, LayerTable* table)
      : array_(array),
        stream_(file, array.offset, array.end),
        count_(count),
        numbers_(file.path(), table, [is_signed = array.kind == 'i'](uint64_t label) {
          const std::string name =
              is_signed ? std::to_string(int64_t(label)) : std::to_string(label);
          return Layer{name, palette_colour(name)};
        }) {}

  uint16_t next() {
    const uint64_t label = read_integer(&stream_, array_);
    if (!count_) return numbers_.of(label);
    if (label >= *count_)
      fail_input(stream_.file().path(),
                 "a label is not the number of one of the " + std::to_string(*count_) + " layers",
                 stream_.offset() - array_.bytes);
    return uint16_t(label);
  }

 private:
  const Array& array_;
  ByteStream stream_;
  std::optional<size_t> count_;
  LabelNumbers numbers_;
};

// In Fortran order, which numpy.argwhere() gives, all x precede all y and all z: one stream per
// axis.
void read_coordinates(const File& file, const Array& array, Labels* labels, const VoxelSink& sink) {
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
    labels != nullptr ? batch.add(voxel, labels->next()) : batch.add(voxel);
  }
  batch.flush();
}

void read_dense(const File& file, const Array& array, const VoxelSink& sink) {
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
double read_number(ByteStream* stream, const Array& array) {
  if (array.kind == 'f' && array.bytes == 4) {
    float number = 0;
    stream->read(std::as_writable_bytes(std::span(&number, 1)));
    return double(number);
  }
  const uint64_t bits = read_integer(stream, array);
  if (array.kind == 'f') return std::bit_cast<double>(bits);
  return array.kind == 'i' ? double(int64_t(bits)) : double(bits);
}

bool is_placement(std::string_view name) {
  return name == "corner" || name == "resolution" || name == "voxel_size";
}

// Reads an array that places the voxels. Such an array is read or rejected, never ignored.
void read_placement(const File& file, std::string_view name, const Array& array,
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

  void consider(std::string_view name, const Array& array) {
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
      if (array.kind == 0) unread_ = name;
      if (array.kind == 'f' && array.shape.size() == 2 && array.shape[1] == 3) points_ = name;
    }
  }

  // The array named "coordinates", else the only candidate.
  const Array& voxels() const {
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
  std::optional<Array> named_, found_;
  bool several_ = false;
  std::string points_;
  std::string unread_;  // the first array of an unsupported type
};

// The arrays of a file that describe its layers; null where it has none.
struct LayerArrays {
  std::optional<Array> label, names, colours, kind;

  void consider(std::string_view name, const Array& array) {
    // An array of more dimensions may hold the voxels.
    if (name == "label" && array.shape.size() == 1) label = array;
    if (name == "layer_names") names = array;
    if (name == "layer_colours") colours = array;
    if (name == "layer_kind") kind = array;
  }
};

// Layers and labels of a file.
class LayerReader {
 public:
  LayerReader(const File& file, const LayerArrays& arrays, LayerTable* table)
      : file_(file), arrays_(arrays), table_(table) {}

  // Fills the table, but for layers that have no name, which their labels add.
  Labels read(uint64_t voxels) {
    const Array& label = *arrays_.label;
    if (!is_integer(label) || label.elements() != voxels)
      fail("label",
           "that is not an integer for each row of \"coordinates\" (--no-layers ignores it)");
    table_->kind = arrays_.kind ? read_kind(*arrays_.kind) : LayerKind::kMaterial;
    if (!arrays_.names) return {file_, label, std::nullopt, table_};
    read_names(*arrays_.names);
    if (arrays_.colours) read_colours(*arrays_.colours);
    return {file_, label, table_->layers.size(), table_};
  }

 private:
  static constexpr uint64_t kMaxNameBytes = uint64_t(64) << 20;  // of all names

  [[noreturn]] void fail(const char* name, const char* sentence) const {
    fail_input(file_.path(), std::string("has an array \"") + name + "\" " + sentence);
  }
  std::string read_bytes(const char* name, const Array& array) const {
    if (array.kind != 'u' || array.bytes != 1 || array.shape.size() != 1 ||
        array.elements() > kMaxNameBytes)
      fail(name, "that is not a row of uint8, of at most 64 MiB");
    std::string text(array.elements(), '\0');
    ByteStream(file_, array.offset, array.end).read(std::as_writable_bytes(std::span(text)));
    return text;
  }
  LayerKind read_kind(const Array& array) const {
    const std::string text = read_bytes("layer_kind", array);
    for (const LayerKind kind : {LayerKind::kObject, LayerKind::kMaterial, LayerKind::kFile}) {
      if (text == layer_kind_name(kind)) return kind;
    }
    fail("layer_kind", "that is not object, material or file");
  }
  void read_names(const Array& array) {
    std::string_view text;
    const std::string bytes = read_bytes("layer_names", array);
    std::unordered_set<std::string_view> seen;
    for (text = bytes; !text.empty();) {
      const size_t end = text.find('\0');
      if (end == std::string_view::npos) fail("layer_names", "that does not end with a zero byte");
      const std::string_view name = text.substr(0, end);
      if (table_->layers.size() == kMaxLayers) fail_many_layers(file_.path());
      if (!seen.insert(name).second)
        fail_input(file_.path(), "two layers are named " + shown_layer(std::string(name)));
      table_->layers.push_back({std::string(name), palette_colour(name)});
      text.remove_prefix(end + 1);
    }
  }
  void read_colours(const Array& array) {
    if (!is_integer(array) || array.shape.size() != 1 || array.elements() != table_->layers.size())
      fail("layer_colours", "that is not an integer for each layer");
    ByteStream stream(file_, array.offset, array.end);
    for (Layer& layer : table_->layers) {
      const uint64_t colour = read_integer(&stream, array);
      if (colour > 0xffffff) fail("layer_colours", "that is not of colours 0xRRGGBB");
      layer.colour = {uint8_t(colour >> 16), uint8_t(colour >> 8), uint8_t(colour)};
    }
  }

  const File& file_;
  const LayerArrays& arrays_;
  LayerTable* table_;
};

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
  const std::string kind = layer_kind_name(window.labels->kind());
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
  begin_array(&zip, "corner", "<f8", "(3,)");
  const Point corner = window.grid.corner();
  for (int a = 0; a < 3; ++a) zip.put(corner[a]);
  zip.end();
  begin_array(&zip, "voxel_size", "<f8", "()");
  zip.put(window.grid.voxel_size);
  zip.end();
  if (window.labels != nullptr) put_labels(window, &zip);
  zip.commit();
}

GridPlacement read_npz(const File& file, const VoxelSink& sink, LayerTable* layers) {
  std::vector<ZipEntry> entries;
  std::array<char, 6> start{};
  file.read_some_at(0, std::as_writable_bytes(std::span(start)));
  const bool zipped = std::string_view(start.data(), 6) != kArrayMagic;
  if (zipped) {
    entries = read_zip(file);
    std::erase_if(entries, [](const ZipEntry& entry) { return !entry.name.ends_with(".npy"); });
  } else {
    entries.push_back({"array.npy", 0, file.size(), 0});
  }
  GridPlacement place;
  VoxelArrayChoice choice(file);
  LayerArrays layer_arrays;
  for (const ZipEntry& entry : entries) {
    const Array array = read_header(file, entry.offset, entry.offset + entry.bytes);
    const std::string_view name(entry.name.data(), entry.name.size() - 4);  // without .npy
    read_placement(file, name, array, &place);
    choice.consider(name, array);
    layer_arrays.consider(name, array);
  }
  const Array& voxels = choice.voxels();
  if (is_dense(voxels)) {
    for (const uint64_t side : voxels.shape) place.resolution = std::max(place.resolution, side);
    read_dense(file, voxels, sink);
  } else if (layers != nullptr && layer_arrays.label) {
    Labels labels = LayerReader(file, layer_arrays, layers).read(voxels.shape[0]);
    read_coordinates(file, voxels, &labels, sink);
  } else {
    read_coordinates(file, voxels, nullptr, sink);
  }
  for (const ZipEntry& entry : entries) {
    if (zipped) check_crc(file, entry);
  }
  return place;
}

}  // namespace svdag
