#include "verify/report/report_plots.h"

#include <algorithm>
#include <cmath>

#include "io/verdict.h"
#include "verify/report/report_text.h"

namespace svdag {
namespace {

// The frame of a plot, in units of the SVG.
constexpr double kWidth = 440, kHeight = 250, kLeft = 40, kRight = 10, kTop = 14, kBottom = 34;

std::string number(double value) {
  return formatted("%.1f", value);
}

std::string text(double x, double y, const char* anchor, const std::string& label) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" +
         escaped(label) + "</text>";
}

std::string line(double x0, double y0, double x1, double y1, const char* css_class) {
  return std::string("<line class=\"") + css_class + "\" x1=\"" + number(x0) + "\" y1=\"" +
         number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" + number(y1) + "\"/>";
}

std::string begin(const std::string& title) {
  return "<figure class=\"plot\"><figcaption>" + escaped(title) +
         "</figcaption><svg viewBox=\"0 0 " + formatted("%.0f", kWidth) + " " +
         formatted("%.0f", kHeight) + "\" role=\"img\" aria-label=\"" + escaped(title) + "\">\n";
}

// x coordinate of level k of `levels`: the middle of its share of the width.
double across(size_t k, size_t levels) {
  return kLeft + (kWidth - kLeft - kRight) * (double(k) + 0.5) / double(levels);
}

std::string level_axis(size_t levels) {
  std::string out = line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "axis");
  for (size_t k = 0; k < levels; ++k)
    out += text(across(k, levels), kHeight - kBottom + 14, "middle", std::to_string(k));
  return out + text((kLeft + kWidth - kRight) / 2, kHeight - 4, "middle", "level") + "\n";
}

// Draws the points of a line, and strokes between neighbouring points.
std::string draw(const PlotLine& series, double decades) {
  const size_t levels = series.values.size();
  const auto height = [&](uint64_t value) {
    return kHeight - kBottom - (kHeight - kTop - kBottom) * std::log10(double(value)) / decades;
  };
  std::string path, points;
  bool drawing = false;
  for (size_t k = 0; k < levels; ++k) {
    const uint64_t value = series.values[k];
    if (value != 0) {
      const std::string x = number(across(k, levels)), y = number(height(value));
      path += (drawing ? "L" : "M") + x + " " + y;
      points += "<circle cx=\"" + x + "\" cy=\"" + y + "\" r=\"3\"><title>" + escaped(series.name) +
                ", level " + std::to_string(k) + ": " + short_count(value) + "</title></circle>";
    }
    drawing = value != 0;
  }
  return "<g class=\"" + series.css_class + "\"><path d=\"" + path + "\"/>" + points + "</g>\n";
}

}  // namespace

std::string plot_lines(const std::string& title, const std::vector<PlotLine>& lines) {
  uint64_t max = 10;
  for (const PlotLine& series : lines) {
    for (const uint64_t value : series.values) max = std::max(max, value);
  }
  const double decades = std::ceil(std::log10(double(max)));
  std::string out = begin(title);
  const int step = decades > 6 ? 3 : 1;
  uint64_t power = 1;
  for (int decade = 0; decade <= int(decades); ++decade, power *= 10) {
    if (decade % step != 0) continue;
    const double y = kHeight - kBottom - (kHeight - kTop - kBottom) * decade / decades;
    out += line(kLeft, y, kWidth - kRight, y, "grid") +
           text(kLeft - 5, y + 4, "end", short_count(power));
  }
  out += level_axis(lines.empty() ? 1 : lines.front().values.size());
  for (const PlotLine& series : lines) out += draw(series, decades);
  out += "</svg><p class=\"legend\">";
  for (const PlotLine& series : lines)
    out += "<span class=\"" + series.css_class + "\">" + escaped(series.name) + "</span> ";
  return out + "</p></figure>\n";
}

std::string plot_columns(const std::string& title, const std::vector<PlotColumn>& columns) {
  double max = 1;
  for (const PlotColumn& column : columns) max = std::max(max, column.value);
  const double width =
      0.7 * (kWidth - kLeft - kRight) / double(std::max<size_t>(columns.size(), 1));
  std::string out = begin(title) + level_axis(columns.size());
  for (size_t k = 0; k < columns.size(); ++k) {
    const double height = (kHeight - kTop - kBottom) * columns[k].value / max;
    const double x = across(k, columns.size()), y = kHeight - kBottom - height;
    out += "<rect class=\"column\" x=\"" + number(x - width / 2) + "\" y=\"" + number(y) +
           "\" width=\"" + number(width) + "\" height=\"" + number(height) + "\"><title>level " +
           std::to_string(k) + ": " + escaped(columns[k].label) + "</title></rect>";
    if (columns[k].value > 0.02 * max) out += text(x, y - 4, "middle", columns[k].label);
  }
  return out + "</svg></figure>\n";
}

std::string plot_bars(const std::string& title, const std::vector<PlotBar>& bars, double whole,
                      const std::string& css_class) {
  std::string out = "<figure class=\"plot\"><figcaption>" + escaped(title) +
                    "</figcaption><table class=\"bars\">\n";
  for (const PlotBar& bar : bars) {
    const double share = whole > 0 ? std::clamp(bar.value / whole, 0.0, 1.0) : 0;
    out += "<tr><th>" + escaped(bar.name) + "<td class=\"bar\"><div class=\"" + css_class +
           "\" style=\"width:" + formatted("%.1f", 100 * share) + "%\"></div><td class=\"n\">" +
           escaped(bar.label) + "\n";
  }
  return out + "</table></figure>\n";
}

}  // namespace svdag
