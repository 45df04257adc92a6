#include "io/formats/output.h"
#include "io/formats/voxels/vox.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr int64_t kTile = 256;
constexpr uint32_t kVoxVersion = 150;

// A chunk whose size is patched in at its end.
class Chunk {
 public:
  Chunk(const char* name, Output* out) : out_(out) {
    out->put(std::string_view(name, 4));
    out->put(uint32_t(0));
    out->put(uint32_t(0));
    begin_ = out->size();
  }
  void end() { out_->patch(begin_ - 8, uint32_t(out_->size() - begin_)); }
  // Ends a chunk whose content is inner chunks only.
  void end_of_inner() { out_->patch(begin_ - 4, uint32_t(out_->size() - begin_)); }

 private:
  Output* out_;
  uint64_t begin_;
};

void put_text(const std::string& text, Output* out) {
  out->put(uint32_t(text.size()));
  out->put(text);
}

// Writes node `id` of the scene graph, which moves node `child` by `translation`.
void put_transform(uint32_t id, uint32_t child, const std::string& translation, Output* out) {
  Chunk chunk("nTRN", out);
  out->put(id);
  out->put(uint32_t(0));  // attributes
  out->put(child);
  out->put(int32_t(-1));  // reserved
  out->put(int32_t(-1));  // layer
  out->put(uint32_t(1));  // frames
  out->put(uint32_t(translation.empty() ? 0 : 1));
  if (!translation.empty()) {
    put_text("_t", out);
    put_text(translation, out);
  }
  chunk.end();
}

void put_shape(uint32_t id, uint32_t model, Output* out) {
  Chunk chunk("nSHP", out);
  out->put(id);
  out->put(uint32_t(0));
  out->put(uint32_t(1));  // models
  out->put(model);
  out->put(uint32_t(0));
  chunk.end();
}

// The number in the palette: of the colour; or of the layer, and the one after the last for voxels
// of no layer.
uint8_t colour_number(const VoxelWindow& window, const ColourPalette* palette, const Voxel& voxel) {
  if (palette != nullptr) return uint8_t(1 + palette->number_of(window.colours->of(voxel)));
  if (window.labels == nullptr) return 1;
  const size_t layers = window.labels->layers().size();
  const size_t number = 1 + std::min<size_t>(window.labels->of(voxel), layers);
  if (number > kMaxPalette)
    fail_usage("vox holds " + format_count(kMaxPalette) + " colours, the file has " +
               format_count(layers) + " layers and voxels of no layer: export one with --layer");
  return uint8_t(number);
}

// Returns the number of voxels of the model.
uint64_t put_model(const VoxelWindow& window, const ColourPalette* palette, const VoxelBox& box,
                   int64_t side, const VoxTurn& turn, Output* out) {
  Chunk size("SIZE", out);
  for (int a = 0; a < 3; ++a) out->put(uint32_t(side));
  size.end();
  Chunk chunk("XYZI", out);
  const uint64_t count_at = out->size();
  out->put(uint32_t(0));
  const uint64_t count = for_each_voxel(window.walk, box, [&](const Voxel& voxel) {
    for (size_t a = 0; a < 3; ++a) {
      const int64_t x = voxel[turn.from[a]] % kTile;
      out->put(uint8_t(turn.flip[a] ? side - 1 - x : x));
    }
    out->put(colour_number(window, palette, voxel));
  });
  out->patch(count_at, uint32_t(count));  // at most 256^3
  chunk.end();
  return count;
}

// `colours`: from 1 on.
void put_palette(std::vector<Colour> colours, Output* out) {
  Chunk chunk("RGBA", out);
  colours.resize(256);
  for (const Colour& colour : colours) {
    for (const uint8_t channel : {colour.r, colour.g, colour.b, uint8_t(255)}) out->put(channel);
  }
  chunk.end();
}

// With the colour of voxels of no layer after the last one's.
std::vector<Colour> colours_of(const std::vector<Layer>& layers) {
  std::vector<Colour> colours;
  for (const Layer& layer : layers) colours.push_back(layer.colour);
  colours.push_back(kNoLayerColour);
  return colours;
}

// The tiles that contain a voxel of the window.
std::vector<LatticePoint> tiles_of(const VoxelWindow& window) {
  std::vector<LatticePoint> tiles;
  const auto add = [&](const LatticePoint& tile) {
    // In Morton order the cubes of a tile are contiguous.
    if (tiles.empty() || tiles.back() != tile) tiles.push_back(tile);
    return tiles.size() <= kMaxVoxModels;
  };
  const bool all = window.walk->visit(window.box(), [&](const VoxelCube& cube) {
    const LatticePoint first = cube.origin / kTile;
    const int64_t n = std::max<int64_t>(cube.side / kTile, 1);
    for (int64_t x = 0; x < n; ++x)
      for (int64_t y = 0; y < n; ++y)
        for (int64_t z = 0; z < n; ++z) {
          if (!add(first + LatticePoint(x, y, z))) return false;
        }
    return true;
  });
  if (!all)
    fail_usage("vox holds models of 256^3 voxels, this window needs more than " +
               format_count(kMaxVoxModels) + ": export a coarser --level, or a part with --bounds");
  return tiles;
}

}  // namespace

void write_vox(const VoxelWindow& window, const ColourPalette* palette, const std::string& path,
               int up) {
  if (window.voxels > kMaxVoxVoxels)
    fail_usage("vox holds at most " + format_count(kMaxVoxVoxels) + " voxels, this window has " +
               format_count(window.voxels) + ": export a coarser --level, or a part with --bounds");
  if (palette == nullptr && window.labels != nullptr &&
      window.labels->layers().size() > kMaxPalette)
    fail_usage("vox holds " + format_count(kMaxPalette) + " colours, the file has " +
               format_count(window.labels->layers().size()) + " layers: export one with --layer");
  const std::vector<LatticePoint> tiles = tiles_of(window);
  const int64_t side = std::min(kTile, window.grid.resolution());
  const VoxTurn turn = vox_turn(up);
  Output out(path);
  out.put("VOX ");
  out.put(kVoxVersion);
  Chunk main("MAIN", &out);
  uint64_t written = 0;
  for (const LatticePoint& tile : tiles) {
    VoxelBox box{tile * kTile, (tile + int64_t(1)) * kTile};
    for (int a = 0; a < 3; ++a) {
      box.min[a] = std::max(box.min[a], window.box().min[a]);
      box.max[a] = std::min(box.max[a], window.box().max[a]);
    }
    written += put_model(window, palette, box, side, turn, &out);
  }
  SVDAG_ASSERT(written == window.voxels);
  // Node 0 places group 1; nodes 2 + 2i and 3 + 2i are the translation and the shape of model i.
  put_transform(0, 1, {}, &out);
  Chunk group("nGRP", &out);
  out.put(uint32_t(1));
  out.put(uint32_t(0));
  out.put(uint32_t(tiles.size()));
  for (uint32_t i = 0; i < tiles.size(); ++i) out.put(2 + 2 * i);
  group.end();
  for (uint32_t i = 0; i < tiles.size(); ++i) {
    const auto [x, y, z] = turn.of(tiles[i] * kTile + side / 2);
    put_transform(2 + 2 * i, 3 + 2 * i,
                  std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z), &out);
    put_shape(3 + 2 * i, i, &out);
  }
  if (palette != nullptr)
    put_palette(palette->colours(), &out);
  else if (window.labels != nullptr)
    put_palette(colours_of(window.labels->layers()), &out);
  main.end_of_inner();
  out.commit();
}

}  // namespace svdag
