// Plots of the report's page, as SVG and HTML without scripts. They scale with the page, take their
// colours from the style sheet, and work with screen readers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace svdag {

// A line of a plot. A value of 0, which a logarithmic axis cannot show, interrupts the line.
struct PlotLine {
  std::string name;
  std::string css_class;  // its colour
  std::vector<uint64_t> values;
};

// Lines of values per level, on a logarithmic axis that begins at 1.
std::string plot_lines(const std::string& title, const std::vector<PlotLine>& lines);

struct PlotColumn {
  double value = 0;
  std::string label;  // above the column
};

// One column per level, with a height in proportion to its value.
std::string plot_columns(const std::string& title, const std::vector<PlotColumn>& columns);

struct PlotBar {
  std::string name;
  double value = 0;
  std::string label;  // the value as text
};

// One horizontal bar per name; a bar of value `whole` is full.
std::string plot_bars(const std::string& title, const std::vector<PlotBar>& bars, double whole,
                      const std::string& css_class);

}  // namespace svdag
