// Plots of the report's page, as SVG and HTML without scripts: they scale with the page, take its
// colours from the style sheet, and can be read aloud.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace svdag {

// A line of a plot. A value of 0 has no place on a logarithmic axis: the line is interrupted there.
struct PlotLine {
  std::string name;
  std::string css_class;  // its colour
  std::vector<uint64_t> values;
};

// Values per level over a logarithmic axis that begins at 1.
std::string plot_lines(const std::string& title, const std::vector<PlotLine>& lines);

struct PlotColumn {
  double value = 0;
  std::string label;  // above the column
};

// A column per level, in proportion to its value.
std::string plot_columns(const std::string& title, const std::vector<PlotColumn>& columns);

struct PlotBar {
  std::string name;
  double value = 0;
  std::string label;  // the value, for people
};

// A bar per name; `whole` is the length of a full bar.
std::string plot_bars(const std::string& title, const std::vector<PlotBar>& bars, double whole,
                      const std::string& css_class);

}  // namespace svdag
