// The layers of an imported file whose labels are arbitrary: numbered in the order in which their
// labels come first.
#pragma once

#include <functional>
#include <string>
#include <unordered_map>

#include "io/dag/layers/layer_table.h"
#include "streaming/error.h"

namespace svdag {

// For a file with more than kMaxLayers layers: Error (kBadInput).
[[noreturn]] inline void fail_many_layers(const std::string& path) {
  fail_input(path,
             "has more than " + std::to_string(kMaxLayers) + " layers (--no-layers ignores them)");
}

class LabelNumbers {
 public:
  // `layer_of`: name and colour of the layer of a label. The table must outlive this.
  LabelNumbers(std::string path, LayerTable* table, std::function<Layer(uint64_t)> layer_of)
      : path_(std::move(path)), table_(table), layer_of_(std::move(layer_of)) {}

  // The number of the layer of `label`, which is added to the table if it is new.
  uint16_t of(uint64_t label) {
    if (label == last_label_ && !numbers_.empty()) return last_;
    const auto [at, is_new] = numbers_.try_emplace(label, uint16_t(table_->layers.size()));
    if (is_new) {
      if (table_->layers.size() == kMaxLayers) fail_many_layers(path_);
      table_->layers.push_back(layer_of_(label));
    }
    last_label_ = label;
    return last_ = at->second;
  }

 private:
  std::string path_;
  LayerTable* table_;
  std::function<Layer(uint64_t)> layer_of_;
  std::unordered_map<uint64_t, uint16_t> numbers_;
  uint64_t last_label_ = 0;  // found last
  uint16_t last_ = 0;
};

}  // namespace svdag
