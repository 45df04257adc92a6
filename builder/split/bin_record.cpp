#include "builder/split/bin_record.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace svdag {
namespace {

bool is_possible(const TriangleBin& bin, int levels) {
  const Cube& cube = bin.cube;
  if (cube.level < 0 || cube.level > levels - 2) return false;
  for (int a = 0; a < 3; ++a) {
    if (cube.coordinate[a] < 0 || cube.coordinate[a] >> cube.level != 0) return false;
  }
  const MortonRange inner = morton_range(cube, levels);
  return bin.range.begin <= inner.begin && inner.end <= bin.range.end &&
         bin.range.end <= uint64_t(1) << 3 * levels;
}

}  // namespace

void put_stream(const SpillStream& stream, RecordWriter* out) {
  out->put(stream.number);
  out->put(stream.bytes);
  out->put(stream.blocks);
}

SpillStream get_stream(RecordReader* in) {
  SpillStream stream;
  in->get(&stream.number);
  in->get(&stream.bytes);
  in->get(&stream.blocks);
  in->require(stream.bytes <= stream.blocks.size() * Scratch::kMaxBlockBytes, "impossible size");
  for (const uint32_t block : stream.blocks) in->require(block != UINT32_MAX, "impossible block");
  return stream;
}

void put_bins(const std::vector<TriangleBin>& bins, RecordWriter* out) {
  out->put(uint64_t(bins.size()));
  for (const TriangleBin& bin : bins) {
    out->put(bin.cube.level);
    out->put(bin.cube.coordinate);
    out->put(bin.range);
    out->put(bin.triangles);
    put_stream(bin.stream, out);
  }
}

std::vector<TriangleBin> get_bins(RecordReader* in, int levels) {
  std::vector<TriangleBin> bins;
  uint64_t count = 0;
  for (in->get(&count); count > 0; --count) {
    TriangleBin& bin = bins.emplace_back();
    in->get(&bin.cube.level);
    in->get(&bin.cube.coordinate);
    in->get(&bin.range);
    in->get(&bin.triangles);
    bin.stream = get_stream(in);
    in->require(is_possible(bin, levels), "its triangles are not in the grid");
  }
  return bins;
}

void put_layers(const SceneLayers& layers, RecordWriter* out) {
  out->put(uint32_t(layers.kind()));
  out->put(uint64_t(layers.layers().size()));
  for (const Layer& layer : layers.layers()) {
    out->put(layer.name);
    out->put(layer.colour);
  }
}

SceneLayers get_layers(RecordReader* in) {
  uint32_t kind = 0;
  uint64_t count = 0;
  in->get(&kind);
  in->get(&count);
  in->require(kind < std::size(kLayerKindNames) && count <= kMaxLayers, "impossible layers");
  std::vector<Layer> read(count);
  for (Layer& layer : read) {
    in->get(&layer.name);
    in->get(&layer.colour);
  }
  SceneLayers layers{LayerKind(kind)};
  layers.restore(std::move(read));
  return layers;
}

void put_cut_outs(const CutOuts& cut_outs, RecordWriter* out) {
  std::vector<const AlphaImage*> images;
  for (const CutOut& cut : cut_outs) {
    if (std::ranges::find(images, cut.image.get()) == images.end())
      images.push_back(cut.image.get());
  }
  out->put(uint64_t(images.size()));
  for (const AlphaImage* image : images) {
    out->put(image->width());
    out->put(image->height());
    out->put(image->texels());
  }
  out->put(uint64_t(cut_outs.size()));
  for (const CutOut& cut : cut_outs) {
    out->put(uint32_t(std::ranges::find(images, cut.image.get()) - images.begin()));
    out->put(uint32_t(cut.wrap_u));
    out->put(uint32_t(cut.wrap_v));
    out->put(uint32_t(cut.nearest));
    out->put(cut.threshold);
  }
}

CutOuts get_cut_outs(RecordReader* in) {
  constexpr const char* kImpossible = "impossible cut-outs";
  std::vector<std::shared_ptr<const AlphaImage>> images;
  uint64_t count = 0;
  for (in->get(&count); count > 0; --count) {
    int64_t width = 0, height = 0;
    std::vector<uint8_t> texels;
    in->get(&width);
    in->get(&height);
    in->get(&texels);
    constexpr int64_t kMaxSide = int64_t(1) << 20;
    in->require(width > 0 && width <= kMaxSide && height > 0 && height <= kMaxSide &&
                    uint64_t(width * height) == texels.size(),
                kImpossible);
    images.push_back(std::make_shared<AlphaImage>(width, height, std::move(texels)));
  }
  CutOuts cut_outs;
  for (in->get(&count); count > 0; --count) {
    CutOut& cut = cut_outs.emplace_back();
    uint32_t image = 0, wrap_u = 0, wrap_v = 0, nearest = 0;
    in->get(&image);
    in->get(&wrap_u);
    in->get(&wrap_v);
    in->get(&nearest);
    in->get(&cut.threshold);
    constexpr uint32_t kLastWrap = uint32_t(Wrap::kClamp);
    in->require(image < images.size() && wrap_u <= kLastWrap && wrap_v <= kLastWrap &&
                    nearest <= 1 && cut.threshold >= 0,
                kImpossible);
    cut.image = images[image];
    cut.wrap_u = Wrap(wrap_u);
    cut.wrap_v = Wrap(wrap_v);
    cut.nearest = nearest == 1;
    cut = with_map(cut);
  }
  return cut_outs;
}

void put_windings(const CellWindings* windings, RecordWriter* out) {
  out->put(uint32_t(windings != nullptr));
  if (windings != nullptr) out->put(windings->entries());
}

std::shared_ptr<const CellWindings> get_windings(RecordReader* in, int levels) {
  uint32_t exist = 0;
  in->get(&exist);
  in->require(exist <= 1, "impossible winding numbers");
  if (exist == 0) return nullptr;
  std::vector<CellWindings::Entry> entries;
  in->get(&entries);
  in->require(CellWindings::are_of_grid(levels, entries), "impossible winding numbers");
  return CellWindings::of_grid(levels, std::move(entries));
}

}  // namespace svdag
