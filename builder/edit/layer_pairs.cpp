#include "builder/edit/layer_pairs.h"

#include <algorithm>
#include <map>

#include "io/dag/dag_view.h"
#include "io/dag/layers/layer_table.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Makes what a file without layers holds its unnamed layer.
void name_all(LayerKind kind, LayerSets* sets) {
  sets->layers.kind = kind;
  sets->layers.layers = {{"", palette_colour("")}};
  sets->roots.push_back(sets->of_union());
}

LayerPairs union_of(const LayerSets& a, const LayerSets& b) {
  LayerPairs pairs;
  pairs.layers.kind = a.layers.kind;
  pairs.layers.has_union = a.layers.has_union && b.layers.has_union;
  std::map<std::string, std::pair<Colour, NodePair>> all;
  for (size_t i = 0; i < a.layers.layers.size(); ++i) {
    const Layer& layer = a.layers.layers[i];
    all[layer.name] = {layer.colour, {a.of_layer(i), kNoChild}};
  }
  for (size_t i = 0; i < b.layers.layers.size(); ++i) {
    const Layer& layer = b.layers.layers[i];
    const NodePair pair{kNoChild, b.of_layer(i)};
    const auto [at, is_new] = all.try_emplace(layer.name, layer.colour, pair);
    if (is_new) continue;
    auto& [colour, nodes] = at->second;
    colour = std::min(colour, layer.colour);
    nodes.b = pair.b;
  }
  if (all.size() > kMaxLayers)
    fail_usage("the files have more than " + std::to_string(kMaxLayers) + " layers together");
  if (pairs.layers.has_union) pairs.roots.push_back({a.of_union(), b.of_union()});
  for (const auto& [name, layer] : all) {
    pairs.layers.layers.push_back({name, layer.first});
    pairs.roots.push_back(layer.second);
  }
  return pairs;
}

// The layers of `a` with those of `b`.
LayerPairs by_name(const LayerSets& a, const LayerSets& b) {
  LayerPairs pairs{a.layers, {}, a.layers.has_union};
  std::map<std::string, uint32_t> of_b;
  for (size_t i = 0; i < b.layers.layers.size(); ++i) of_b[b.layers.layers[i].name] = b.of_layer(i);
  for (size_t i = 0; i < a.layers.layers.size(); ++i) {
    const auto found = of_b.find(a.layers.layers[i].name);
    pairs.roots.push_back({a.of_layer(i), found == of_b.end() ? kNoChild : found->second});
  }
  return pairs;
}

}  // namespace

LayerPairs match_layers(SetOperation operation, LayerSets a, LayerSets b) {
  if (!a.layers.empty() && !b.layers.empty() && a.layers.kind != b.layers.kind)
    fail_usage(a.path + " and " + b.path + " differ in what a layer is: " +
               layer_kind_name(a.layers.kind) + " and " + layer_kind_name(b.layers.kind));
  if (operation == SetOperation::kUnion && a.layers.empty() != b.layers.empty())
    a.layers.empty() ? name_all(b.layers.kind, &a) : name_all(a.layers.kind, &b);
  if (operation == SetOperation::kUnion && !a.layers.empty()) return union_of(a, b);
  if (!a.layers.empty() && !b.layers.empty()) return by_name(a, b);
  if (operation == SetOperation::kIntersection && a.layers.empty()) {
    LayerPairs pairs{b.layers, {}};
    for (const uint32_t root : b.roots) pairs.roots.push_back({a.of_union(), root});
    return pairs;
  }
  if (!b.layers.has_union)
    fail_usage(b.path + ": has no union of its layers to subtract: choose one with --layer");
  LayerPairs pairs{a.layers, {}};
  for (const uint32_t root : a.roots) pairs.roots.push_back({root, b.of_union()});
  return pairs;
}

}  // namespace svdag
