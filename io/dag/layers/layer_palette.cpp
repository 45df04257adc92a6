#include "io/dag/layers/layer_palette.h"

#include <optional>
#include <set>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/printable.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxBytes = uint64_t(16) << 20;
constexpr const char* kSpace = " \t\r";

std::string trimmed(const std::string& text) {
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

}  // namespace

LayerPalette read_palette(const std::string& path) {
  const File file = File::open_read(path);
  if (file.size() > kMaxBytes) fail_input(path, "is not a palette: it has more than 16 MiB");
  const std::string text = file.text();
  LayerPalette palette{path, {}};
  uint64_t number = 0;
  for (size_t at = 0; at < text.size(); ++number) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = trimmed(text.substr(at, end - at));
    at = end + 1;
    if (line.empty() || line[0] == '#') continue;
    const size_t space = line.find_last_of(kSpace);
    const auto colour =
        space == std::string::npos ? std::nullopt : parse_colour(line.substr(space + 1));
    if (!colour)
      fail_input(path, "line " + format_count(number + 1) +
                           " is not a name and a colour, such as: leaf* #3a7d2c");
    palette.lines.push_back({trimmed(line.substr(0, space)), *colour});
  }
  return palette;
}

PaletteUse apply_palette(const LayerPalette& palette, LayerTable* table) {
  if (table->empty()) fail_usage("--palette: the file has no layers (svdag build --layers)");
  PaletteUse use;
  std::set<size_t> coloured;
  for (const LayerPalette::Line& line : palette.lines) {
    const std::set<size_t> found = layers_matching(*table, line.pattern);
    if (found.empty()) use.unmatched.push_back(line.pattern);
    for (const size_t number : found) table->layers[number].colour = line.colour;
    coloured.insert(found.begin(), found.end());
  }
  use.layers = coloured.size();
  return use;
}

std::string palette_text(const LayerPalette& palette, const LayerTable& table) {
  LayerTable copy = table;
  const PaletteUse use = apply_palette(palette, &copy);
  std::string text = "palette: the colours of " + format_count(use.layers) + " of " +
                     format_count(table.layers.size(), "layer");
  constexpr size_t kShown = 3;
  for (size_t i = 0; i < std::min(use.unmatched.size(), kShown); ++i)
    text += (i == 0 ? "; no layer is named " : ", ") + printable(use.unmatched[i]);
  if (use.unmatched.size() > kShown)
    text += ", and " + format_count(use.unmatched.size() - kShown) + " more";
  return text;
}

}  // namespace svdag
