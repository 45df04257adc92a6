#include "io/dag/layers/layer_table.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstring>
#include <span>

#include "io/suggest.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

// A name in patterns and suggestions.
std::string typed_name(const Layer& layer) {
  return layer.name.empty() ? shown_layer("") : layer.name;
}

[[noreturn]] void fail_no_layer(const LayerTable& table, const std::string& name) {
  if (table.empty()) fail_usage("--layer: the file has no layers");
  std::vector<std::string> names;
  for (const Layer& layer : table.layers) names.push_back(typed_name(layer));
  const std::string near = nearest(name, names);
  fail_usage("--layer: the file has no layer \"" + printable(name) + "\"" +
             (near.empty() ? "" : "; did you mean \"" + printable(near) + "\"?") +
             " (svdag info --layers lists them)");
}

// The layer of exactly this name; nothing if there is none.
std::optional<size_t> exactly_named(const LayerTable& table, const std::string& name) {
  const std::vector<Layer>& layers = table.layers;
  auto found = std::ranges::find(layers, name, &Layer::name);
  if (found == layers.end() && name == shown_layer(""))
    found = std::ranges::find(layers, "", &Layer::name);
  if (found == layers.end()) return std::nullopt;
  return size_t(found - layers.begin());
}

// Error (kUsage) if no layer matches.
std::set<size_t> matching(const LayerTable& table, const std::string& pattern) {
  std::set<size_t> numbers = layers_matching(table, pattern);
  if (numbers.empty()) fail_no_layer(table, pattern);
  return numbers;
}

}  // namespace

std::string shown_layer(const std::string& name) {
  return name.empty() ? "(unnamed)" : printable(name);
}

std::set<size_t> layers_matching(const LayerTable& table, const std::string& pattern) {
  if (const auto exact = exactly_named(table, pattern)) return {*exact};
  std::set<size_t> numbers;
  for (size_t i = 0; i < table.layers.size(); ++i) {
    if (fnmatch(pattern.c_str(), typed_name(table.layers[i]).c_str(), 0) == 0) numbers.insert(i);
  }
  return numbers;
}

std::vector<size_t> layers_named(const LayerTable& table, const std::vector<std::string>& names) {
  std::set<size_t> chosen, excluded;
  bool only_excludes = true;
  for (const std::string& name : names) {
    const bool excludes = name.starts_with('!') && !exactly_named(table, name);
    only_excludes = only_excludes && excludes;
    (excludes ? excluded : chosen).merge(matching(table, excludes ? name.substr(1) : name));
  }
  if (only_excludes) {
    for (size_t i = 0; i < table.layers.size(); ++i) chosen.insert(i);
  }
  for (const size_t number : excluded) chosen.erase(number);
  if (chosen.empty()) fail_usage("--layer: the patterns exclude every layer");
  return {chosen.begin(), chosen.end()};
}

uint32_t LayerTable::default_root() const {
  if (has_union) return union_root;
  for (const Layer& layer : layers) {
    if (layer.root != kNoRoot) return layer.root;
  }
  return kNoRoot;
}

uint64_t LayerTable::default_voxels(uint64_t of_union) const {
  if (has_union) return of_union;
  for (const Layer& layer : layers) {
    if (layer.voxels != 0) return layer.voxels;
  }
  return 0;
}

std::vector<std::byte> encode_layers(const LayerTable& table) {
  std::vector<std::byte> bytes(table.layers.size() * sizeof(StoredLayer));
  for (size_t i = 0; i < table.layers.size(); ++i) {
    const Layer& layer = table.layers[i];
    const StoredLayer stored{layer.voxels,
                             layer.root,
                             uint32_t(layer.name.size()),
                             {layer.colour.r, layer.colour.g, layer.colour.b},
                             {}};
    std::memcpy(bytes.data() + i * sizeof stored, &stored, sizeof stored);
  }
  for (const Layer& layer : table.layers) {
    const auto name = std::as_bytes(std::span(layer.name));
    bytes.insert(bytes.end(), name.begin(), name.end());
  }
  return bytes;
}

std::optional<std::vector<Layer>> decode_entries(uint32_t count, std::span<const std::byte> bytes) {
  if (count > bytes.size() / sizeof(StoredLayer)) return std::nullopt;
  std::vector<Layer> layers(count);
  std::span<const std::byte> names = bytes.subspan(count * sizeof(StoredLayer));
  for (uint32_t i = 0; i < count; ++i) {
    StoredLayer stored;
    std::memcpy(&stored, bytes.data() + i * sizeof stored, sizeof stored);
    const bool is_zero = std::ranges::all_of(stored.reserved, [](uint8_t b) { return b == 0; });
    if (stored.name_bytes > names.size() || !is_zero ||
        (stored.voxels == 0 && stored.root != kNoRoot))
      return std::nullopt;
    Layer& layer = layers[i];
    layer.name.assign(reinterpret_cast<const char*>(names.data()), stored.name_bytes);
    layer.colour = {stored.colour[0], stored.colour[1], stored.colour[2]};
    layer.voxels = stored.voxels;
    layer.root = stored.root;
    names = names.subspan(stored.name_bytes);
    if (i > 0 && layers[i - 1].name >= layer.name) return std::nullopt;
  }
  if (!names.empty()) return std::nullopt;
  return layers;
}

std::optional<LayerTable> decode_layers(const Header& header, std::span<const std::byte> bytes) {
  if (!has_possible_roots(header)) return std::nullopt;
  auto layers = decode_entries(header.layer_count, bytes);
  if (!layers) return std::nullopt;
  LayerTable table{LayerKind(header.layer_kind), header.layer_kind == 0 || header.has_union != 0, 0,
                   std::move(*layers)};
  const uint64_t roots = header.sections[0].nodes;
  std::vector<bool> used(roots);
  if (roots > 0 && table.has_union) used[0] = true;
  for (const Layer& layer : table.layers) {
    if (layer.root == kNoRoot ? layer.voxels != 0 : layer.root >= roots) return std::nullopt;
    if (layer.root != kNoRoot) used[layer.root] = true;
  }
  const bool in_order = roots == 0 || table.default_root() == 0;
  const bool all_used = std::ranges::find(used, false) == used.end();
  if (!in_order || !all_used) return std::nullopt;
  return table;
}

Colour palette_colour(std::string_view name) {
  if (name.empty()) return kNeutralColour;
  constexpr uint64_t kHues = 48;
  constexpr double kTones[3][2] = {{0.85, 0.5}, {0.62, 0.5}, {0.95, 0.72}};  // bright; pale
  const uint64_t hash = checksum64(std::as_bytes(std::span(name)));
  const double hue = 6 * double(hash % kHues) / double(kHues);
  const auto& tone = kTones[hash / kHues % 3];
  const double bright = tone[0], pale = tone[1];
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return colour_code(bright * (1 - (1 - pale) * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

}  // namespace svdag
