// Points as text: a line for each, x y z. Further numbers are skipped, except the colours of
// point_files.h. Numbers are separated by blanks, or by a comma or semicolon; lines that begin with
// '#' or "//" are comments.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "io/formats/points/point_files.h"
#include "io/values/decimal.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

constexpr size_t kColumns = 6;  // that matter

struct XyzRow {
  std::array<double, kColumns> values{};
  size_t count = 0;       // of numbers, at most kColumns + 1
  bool has_whole = true;  // whether the last three are written without fractions
};

constexpr bool is_separator(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';';
}

// Colours are whole numbers from 0 to 255.
bool has_colour(const XyzRow& row) {
  const auto is_channel = [](double v) { return v >= 0 && v <= 255; };
  return row.count == kColumns && row.has_whole &&
         std::all_of(row.values.begin() + 3, row.values.end(), is_channel);
}

class XyzLines {
 public:
  explicit XyzLines(const File& file) : stream_(file) {}

  // The next line with numbers; returns false at the end.
  bool next(XyzRow* row) {
    for (;;) {
      const auto line = stream_.line(kLongestLine);
      if (!line) return false;
      ++number_;
      std::string_view text = *line;
      while (!text.empty() && is_separator(text.front())) text.remove_prefix(1);
      if (text.empty() || text.front() == '#' || text.starts_with("//")) continue;
      parse(text, row);
      return true;
    }
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    fail_input(stream_.file().path(), sentence + " (line " + std::to_string(number_) + ")");
  }

 private:
  static constexpr size_t kLongestLine = 1 << 14;

  void parse(std::string_view text, XyzRow* row) const {
    *row = {};
    const char *p = text.data(), *const end = p + text.size();
    while (p != end && row->count <= kColumns) {
      double value = 0;
      const char* const from = p + (*p == '+' && end - p > 1 && p[1] != '-' ? 1 : 0);
      const auto [stop, error] = parse_decimal(from, end, value);
      // Numbers beyond a double, and what is not a number.
      if (error != std::errc{} || (stop != end && !is_separator(*stop))) {
        if (row->count < 3) fail("has a coordinate that is not a number");
        row->count = kColumns + 1;  // text after the coordinates
        return;
      }
      if (row->count < kColumns) row->values[row->count] = value;
      if (row->count >= 3 && std::any_of(from, stop, [](char c) { return c < '0' || c > '9'; }))
        row->has_whole = false;
      ++row->count;
      p = std::find_if_not(stop, end, is_separator);
    }
    if (row->count < 3) fail("has fewer than three numbers");
  }

  ByteStream stream_;
  uint64_t number_ = 0;  // of the line
};

class XyzCloud final : public PointCloud {
 public:
  explicit XyzCloud(const File& file) : file_(file) {
    XyzRow first;
    has_colours = XyzLines(file).next(&first) && has_colour(first);
  }

  uint64_t read(const PointSink& sink) const override {
    PointCollector out(sink);
    XyzLines lines(file_);
    for (XyzRow row; lines.next(&row);) {
      const bool is_added = out.add({row.values[0], row.values[1], row.values[2]});
      if (!has_colours || !is_added) continue;
      if (!has_colour(row))
        lines.fail(
            "has no colour after the coordinates, as the first line has (--no-colours ignores "
            "colours)");
      PointColour colour;
      for (size_t c = 0; c < 3; ++c) colour[c] = uint16_t(row.values[3 + c] * 257);
      out.add_colour(colour);
    }
    return out.finish();
  }

 private:
  const File& file_;
};

}  // namespace

std::unique_ptr<PointCloud> open_xyz(const File& file) {
  return std::make_unique<XyzCloud>(file);
}

}  // namespace svdag
