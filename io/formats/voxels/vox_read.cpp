#include <charconv>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "io/formats/label_numbers.h"
#include "io/formats/voxels/vox.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

using Offset = std::array<int64_t, 3>;
using Dictionary = std::map<std::string, std::string>;

constexpr uint32_t kNoLayer = ~0u;

bool is_hidden(const Dictionary& attributes) {
  const auto found = attributes.find("_hidden");
  return found != attributes.end() && found->second == "1";
}

// Colour `i` of the palette that a file without RGBA has: six steps of red, green and blue from
// white on, blue fastest, then ramps of red, green, blue and grey. No program uses colour 0.
Colour default_colour(uint64_t i) {
  if (i == 0) return {};
  const auto step = [](uint64_t n) { return uint8_t(255 - 51 * (n % 6)); };
  if (i < 216) return {step((i - 1) / 36), step((i - 1) / 6), step(i - 1)};
  constexpr uint8_t kRamp[10] = {0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11};
  const uint64_t ramp = (i - 216) / 10;
  const uint8_t bright = kRamp[(i - 216) % 10];
  const auto channel = [&](uint64_t which) {
    return ramp == which || ramp == 3 ? bright : uint8_t(0);
  };
  return {channel(0), channel(1), channel(2)};
}

using Turn = VoxTurn;

struct Model {
  std::array<uint32_t, 3> size;
  uint64_t offset, count;  // of its voxel records in the file
};

// A node of the scene graph: a translation after a turn (one child), a group (its children), or a
// shape (its models are the frames of an animation; only the first is read).
struct SceneNode {
  Offset translation{};
  uint32_t layer = kNoLayer;
  bool hidden = false;
  Turn turn;
  std::vector<uint32_t> children, models;
  size_t visits = 0;  // number of nodes visited from this one on; 0: not counted
};

struct PlacedModel {
  uint32_t model;
  Offset corner;  // of its turned box
  Turn turn;
};

// Reads the contents of one chunk; reading past its end is an Error.
class ChunkReader {
 public:
  ChunkReader(ByteStream* stream, uint64_t bytes) : stream_(stream), left_(bytes) {
    if (bytes > stream->remaining()) fail();
  }
  uint32_t number() {
    uint32_t value;
    consume(sizeof value);
    stream_->read(std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }
  std::string text() {
    const uint32_t length = number();
    consume(length);
    std::string text(length, '\0');
    stream_->read(std::as_writable_bytes(std::span(text)));
    return text;
  }
  // The number of items that follow, of at least 4 bytes each.
  uint32_t count() {
    const uint32_t n = number();
    if (n > left_ / 4) fail();
    return n;
  }
  Dictionary dictionary() {
    Dictionary entries;
    for (uint32_t n = count(); n > 0; --n) {
      const std::string key = text();
      entries[key] = text();
    }
    return entries;
  }
  void skip_rest() { stream_->skip(std::exchange(left_, 0)); }
  uint64_t left() const { return left_; }
  uint64_t offset() const { return stream_->offset(); }
  [[noreturn]] void fail() const {
    fail_input(stream_->file().path(), "damaged .vox file: a chunk ends too early",
               stream_->offset());
  }

 private:
  void consume(uint64_t bytes) {
    if (bytes > left_) fail();
    left_ -= bytes;
  }

  ByteStream* stream_;
  uint64_t left_;
};

class VoxReader {
 public:
  VoxReader(const File& file, LayerTable* layers, bool with_colours, int up)
      : file_(file),
        to_grid_(vox_turn(up).inverse()),
        layers_(layers),
        with_colours_(with_colours),
        labels_(file.path(), layers, [this](uint64_t label) { return layer_of(label); }) {}

  GridPlacement read(const VoxelSink& sink) {
    read_chunks();
    if (nodes_.empty()) {
      const size_t shown = std::min<size_t>(models_.size(), has_frames_ ? 1 : models_.size());
      for (uint32_t i = 0; i < shown; ++i) place_model(i, to_grid_.of(middle_voxel(i)), to_grid_);
    } else {
      count_visits(0, 0);
      place_node(0, {}, to_grid_, 0);
    }
    Offset low{};  // minimum, if below 0
    for (const PlacedModel& placed : placed_) {
      for (size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], placed.corner[a]);
    }
    with_colours_ = with_colours_ && (palette_ || has_two_numbers());
    VoxelBatch batch(sink);
    for (const PlacedModel& placed : placed_) {
      Offset at;
      for (size_t a = 0; a < 3; ++a) at[a] = placed.corner[a] - low[a];
      read_voxels(models_[placed.model], at, placed.turn, &batch);
    }
    batch.flush();
    if (layers_ != nullptr && (palette_ || layers_->layers.size() > 1))
      layers_->kind = LayerKind::kMaterial;
    else if (layers_ != nullptr)
      *layers_ = {};
    return {};
  }

 private:
  // A small file can repeat its models exponentially often.
  static constexpr size_t kMaxVisits = size_t(1) << 20;
  static constexpr uint64_t kMaxVoxels = uint64_t(1) << 32;
  static constexpr int kMaxDepth = 64;

  Layer layer_of(uint64_t label) const {
    const std::string number = std::to_string(label);
    return {"colour-" + std::string(3 - number.size(), '0') + number, colour_of(label)};
  }
  Colour colour_of(uint64_t number) const {
    return palette_ ? (*palette_)[size_t(number)] : default_colour(number);
  }
  // Whether the placed voxels have several numbers of the palette.
  bool has_two_numbers() const {
    std::optional<uint8_t> first;
    for (const PlacedModel& placed : placed_) {
      const Model& model = models_[placed.model];
      ByteStream stream(file_, model.offset, model.offset + 4 * model.count);
      while (!stream.at_end()) {
        std::array<uint8_t, 4> record;
        stream.read(std::as_writable_bytes(std::span(record)));
        if (record[3] != first.value_or(record[3])) return true;
        first = record[3];
      }
    }
    return false;
  }

  Offset middle_voxel(uint32_t model) const {
    Offset middle;
    for (size_t a = 0; a < 3; ++a) middle[a] = models_[model].size[a] / 2;
    return middle;
  }

  void read_chunks() {
    ByteStream stream(file_);
    ChunkReader head(&stream, std::min<uint64_t>(stream.remaining(), 20));
    if (head.left() < 20 || head.number() != 0x20584f56)  // "VOX "
      fail_input(file_.path(), "is not a .vox file (it does not begin with \"VOX \")", 0);
    head.number();  // version
    if (head.number() != 0x4e49414d) fail_input(file_.path(), "has no MAIN chunk", 8);
    stream.skip(8);
    std::array<uint32_t, 3> size{};
    while (!stream.at_end()) {
      std::array<char, 4> name;
      stream.read(std::as_writable_bytes(std::span(name)));
      ChunkReader sizes(&stream, 8);
      const uint64_t own = sizes.number(), inner = sizes.number();
      ChunkReader chunk(&stream, own + inner);
      read_chunk({name.data(), 4}, &chunk, &size);
      chunk.skip_rest();
    }
  }

  void read_chunk(std::string_view name, ChunkReader* chunk, std::array<uint32_t, 3>* size) {
    if (name == "SIZE") {
      for (uint32_t& side : *size) side = chunk->number();
    } else if (name == "XYZI") {
      const uint32_t count = chunk->count();
      models_.push_back({*size, chunk->offset(), count});
    } else if (name == "RGBA") {
      read_palette(chunk);
    } else if (name == "PACK") {
      has_frames_ = true;
    } else if (name == "nTRN") {
      const uint32_t id = chunk->number();
      SceneNode node;
      node.hidden = is_hidden(chunk->dictionary());
      node.children = {chunk->number()};
      chunk->number();  // reserved
      node.layer = chunk->number();
      if (chunk->count() > 0) read_frame(chunk->dictionary(), &node);
      nodes_[id] = std::move(node);
    } else if (name == "nGRP" || name == "nSHP") {
      SceneNode& node = nodes_[chunk->number()];
      node.hidden = is_hidden(chunk->dictionary());
      for (uint32_t n = chunk->count(); n > 0; --n) {
        (name == "nGRP" ? node.children : node.models).push_back(chunk->number());
        if (name == "nSHP") chunk->dictionary();
      }
    } else if (name == "LAYR") {
      const uint32_t layer = chunk->number();
      if (is_hidden(chunk->dictionary())) hidden_layers_.insert(layer);
    }
  }

  void read_palette(ChunkReader* chunk) {
    palette_.emplace();
    for (size_t i = 1; i < 256; ++i) {
      const uint32_t rgba = chunk->number();
      (*palette_)[i] = {uint8_t(rgba), uint8_t(rgba >> 8), uint8_t(rgba >> 16)};
    }
  }

  void read_frame(const Dictionary& frame, SceneNode* node) const {
    if (const auto r = frame.find("_r"); r != frame.end()) node->turn = turn_of(r->second);
    const auto t = frame.find("_t");
    if (t == frame.end()) return;
    long long x, y, z;
    if (std::sscanf(t->second.c_str(), "%lld %lld %lld", &x, &y, &z) != 3)
      fail_input(file_.path(), "damaged .vox file: a translation is not three integers");
    node->translation = {x, y, z};
  }

  // Bits 0-1 and 2-3: the axes that the first two come from; bits 4-6: whether they are flipped.
  Turn turn_of(const std::string& text) const {
    unsigned bits = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bits);
    const unsigned x = bits & 3, y = bits >> 2 & 3;
    if (error != std::errc() || end != text.data() + text.size() || bits > 127 || x == 3 ||
        y == 3 || x == y)
      fail_input(file_.path(), "damaged .vox file: a rotation is not one");
    return {{uint8_t(x), uint8_t(y), uint8_t(3 - x - y)},
            {(bits & 16) != 0, (bits & 32) != 0, (bits & 64) != 0}};
  }

  SceneNode& node_of(uint32_t id, int depth) {
    const auto found = nodes_.find(id);
    if (found == nodes_.end() || depth > kMaxDepth) fail_graph();
    return found->second;
  }
  [[noreturn]] void fail_graph() const {
    fail_input(file_.path(), "damaged .vox file: invalid scene graph");
  }

  // Visits each node once, before place_node() visits it once per path that leads to it.
  size_t count_visits(uint32_t id, int depth) {
    SceneNode& node = node_of(id, depth);
    if (node.visits != 0) return node.visits;
    size_t visits = 1;
    for (const uint32_t child : node.children) {
      visits += count_visits(child, depth + 1);
      if (visits > kMaxVisits) fail_graph();
    }
    return node.visits = visits;
  }

  // `reject_reason`: why models below this node cannot be read; null if they can.
  void place_node(uint32_t id, const Offset& from, const Turn& outer, int depth,
                  const char* reject_reason = nullptr) {
    const SceneNode& node = node_of(id, depth);
    if (node.hidden || hidden_layers_.contains(node.layer)) return;
    Offset at = from;
    for (size_t a = 0; a < 3; ++a) {
      const int64_t move = node.translation[outer.from[a]];
      const bool far = move < -(int64_t(1) << kMaxLevels) || move > int64_t(1) << kMaxLevels;
      if (far) reject_reason = "has a model further than 1M voxels from 0";
      if (!far) at[a] += outer.flip[a] ? -move : move;
    }
    const Turn turn = outer.after(node.turn);
    for (const uint32_t child : node.children)
      place_node(child, at, turn, depth + 1, reject_reason);
    if (node.models.empty()) return;
    if (reject_reason != nullptr) fail_input(file_.path(), reject_reason);
    place_model(node.models.front(), at, turn);
  }

  // Places the corner of voxel size/2 (rounded down) of the model at `middle`, turned around it.
  void place_model(uint32_t model, const Offset& middle, const Turn& turn) {
    if (model >= models_.size()) fail_graph();
    voxels_ += models_[model].count;
    if (placed_.size() >= kMaxVisits || voxels_ > kMaxVoxels)
      fail_input(file_.path(), "shows more than 2^20 models or 2^32 voxels");
    const Offset half = middle_voxel(model);
    Offset corner;
    for (size_t a = 0; a < 3; ++a) {
      const size_t b = turn.from[a];
      corner[a] = middle[a] - (turn.flip[a] ? models_[model].size[b] - half[b] : half[b]);
    }
    placed_.push_back({model, corner, turn});
  }

  void read_voxels(const Model& model, const Offset& at, const Turn& turn, VoxelBatch* batch) {
    ByteStream stream(file_, model.offset, model.offset + 4 * model.count);
    while (!stream.at_end()) {
      std::array<uint8_t, 4> record;
      stream.read(std::as_writable_bytes(std::span(record)));
      Voxel voxel;
      for (size_t a = 0; a < 3; ++a) {
        const size_t b = turn.from[a];
        const int64_t x = at[a] + (turn.flip[a] ? model.size[b] - 1 - record[b] : record[b]);
        if (record[b] >= model.size[b] || x >= int64_t(1) << kMaxLevels)
          fail_input(file_.path(), "a voxel is outside of its model or of 1M^3",
                     stream.offset() - 4);
        voxel[a] = uint32_t(x);
      }
      batch->add(voxel);
      if (layers_ != nullptr) batch->add_label(labels_.of(record[3]));
      if (with_colours_) batch->add_colour(colour_of(record[3]));
    }
  }

  const File& file_;
  Turn to_grid_;
  LayerTable* layers_;
  bool with_colours_;
  LabelNumbers labels_;
  std::optional<std::array<Colour, 256>> palette_;
  std::vector<Model> models_;
  std::map<uint32_t, SceneNode> nodes_;
  std::set<uint32_t> hidden_layers_;
  bool has_frames_ = false;  // PACK chunk: without a scene graph, models are animation frames
  std::vector<PlacedModel> placed_;
  uint64_t voxels_ = 0;  // total of placed_
};

}  // namespace

GridPlacement read_vox(const File& file, const VoxelSink& sink, LayerTable* layers,
                       bool with_colours, int up) {
  return VoxReader(file, layers, with_colours, up).read(sink);
}

}  // namespace svdag
