// The layers of an imported `.npz` archive, and the labels of its voxels.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "io/dag/layers/layer_table.h"
#include "io/formats/label_numbers.h"
#include "io/formats/voxels/npy_array.h"

namespace svdag {

// The arrays of a file that describe its layers; null where it has none.
struct NpzLayerArrays {
  std::optional<NpyArray> label, names, colours, kind;

  void consider(std::string_view name, const NpyArray& array) {
    // A single number is something else than a label of each row.
    const bool is_number = is_integer(array) && array.shape.empty();
    if (name == "label" && !is_number) label = array;
    if (name == "layer_names") names = array;
    if (name == "layer_colours") colours = array;
    if (name == "layer_kind") kind = array;
  }
};

// The labels of voxels, row by row.
class NpzLabels {
 public:
  // `array`: an integer for each voxel. `count`: of the layers in `table`, by number;
  // none: each integer becomes one.
  NpzLabels(const File& file, const NpyArray& array, std::optional<size_t> count, LayerTable* table)
      : array_(array),
        stream_(file, array.offset, array.end),
        count_(count),
        table_(table),
        numbers_(file.path(), table, [is_signed = array.kind == 'i'](uint64_t label) {
          const std::string name =
              is_signed ? std::to_string(int64_t(label)) : std::to_string(label);
          return Layer{name, palette_colour(name)};
        }) {}

  uint16_t next() {
    const uint64_t label = read_integer(&stream_, array_);
    if (!count_) return numbers_.of(label);
    if (label == kNoLabel || label == uint64_t(-1)) return unnamed();
    if (label >= *count_)
      fail_input(stream_.file().path(),
                 "label " + std::to_string(label) + " is not the number of one of the " +
                     std::to_string(*count_) + " layers",
                 stream_.offset() - array_.bytes);
    return uint16_t(label);
  }

 private:
  static constexpr uint64_t kNoLabel = 0xffff;  // of a voxel of no layer, as is -1

  // The unnamed layer, for voxels of no layer.
  uint16_t unnamed() {
    if (unnamed_) return *unnamed_;
    const auto found = std::ranges::find(table_->layers, std::string(), &Layer::name);
    unnamed_ = uint16_t(found - table_->layers.begin());
    if (found != table_->layers.end()) return *unnamed_;
    if (table_->layers.size() == kMaxLayers) fail_many_layers(stream_.file().path());
    table_->layers.push_back({"", palette_colour("")});
    return *unnamed_;
  }

  const NpyArray& array_;
  ByteStream stream_;
  std::optional<size_t> count_;
  LayerTable* table_;
  std::optional<uint16_t> unnamed_;
  LabelNumbers numbers_;
};

// The labels of `voxels` voxels, of a file that has them. Fills the empty `table`, except with
// layers without names, which their labels add. Errors: kBadInput.
NpzLabels read_npz_layers(const File& file, const NpzLayerArrays& arrays, uint64_t voxels,
                          LayerTable* table);

}  // namespace svdag
