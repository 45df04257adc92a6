// The colours of layers by their names, from a text file (--palette).
//
// A line has a name, or a pattern as in --layer, and a colour #rrggbb. Of the lines that match a
// layer the last one counts, so a palette goes from the general to the exception. Empty lines, and
// those that begin with #, are skipped. A line that matches no layer is not an error: a palette
// serves many files.
#pragma once

#include <string>
#include <vector>

#include "io/dag/layers/layer_table.h"

namespace svdag {

struct LayerPalette {
  struct Line {
    std::string pattern;
    Colour colour;
  };
  std::string path;  // empty: there is none
  std::vector<Line> lines;

  bool empty() const { return path.empty(); }
};

// Error (kBadInput) with the number of a line that has no colour.
LayerPalette read_palette(const std::string& path);

struct PaletteUse {
  size_t layers = 0;                   // that got a colour
  std::vector<std::string> unmatched;  // patterns
};

// Error (kUsage) if there are no layers.
PaletteUse apply_palette(const LayerPalette& palette, LayerTable* table);

// "palette: the colours of 3 of 5 layers", and the first patterns that match none.
std::string palette_text(const LayerPalette& palette, const LayerTable& table);

}  // namespace svdag
