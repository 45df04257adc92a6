// PCD 0.7 and earlier, of the Point Cloud Library: a header of text lines, then rows of fields.
//
// The pose of the sensor (VIEWPOINT) is not applied, as in that library. Colours are the field rgb
// or rgba: 0xRRGGBB in the bits of a float or an integer of 4 bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <string>

#include "io/formats/points/point_files.h"
#include "io/values/endian.h"
#include "io/values/text_scan.h"
#include "streaming/error.h"
#include "streaming/file/byte_stream.h"

namespace svdag {
namespace {

struct PcdField {
  std::string name;
  uint64_t bytes = 4;
  char type = 'F';     // F, I or U
  uint64_t count = 1;  // of values
  uint64_t first = 0;  // offset in a row; of text: number of its first value
};

struct PcdHeader {
  std::vector<PcdField> fields;
  uint64_t points = 0;
  uint64_t row = 0;  // bytes of a row; of text: values
  bool is_text = false;
  uint64_t body = 0;   // offset
  uint64_t lines = 0;  // of the header
};

class PcdHeaderParser {
 public:
  explicit PcdHeaderParser(const File& file) : stream_(file) {}

  PcdHeader parse() {
    while (!next_line()) {
    }
    header_.body = stream_.offset();
    if (header_.fields.empty()) fail("has a header without FIELDS");
    header_.points = has_points_ ? header_.points : width_ * height_;
    for (PcdField& field : header_.fields) {
      field.first = header_.row;
      header_.row += (header_.is_text ? 1 : field.bytes) * field.count;
    }
    if (header_.row > kMaxRow) fail("has points of more than 1 MiB");
    // A value of text takes a digit and a blank, except the last of the file.
    const uint64_t room = header_.is_text ? (stream_.remaining() + 1) / 2 : stream_.remaining();
    if (header_.row == 0 || header_.points > room / header_.row)
      fail("promises " + std::to_string(header_.points) + " points, more than its bytes can hold");
    return std::move(header_);
  }

 private:
  static constexpr uint64_t kMaxLines = 1000, kMaxFields = 1000, kMaxCount = 1 << 16;
  static constexpr uint64_t kMaxRow = 1 << 20;

  // Returns whether it was the last line, DATA.
  bool next_line() {
    if (++header_.lines > kMaxLines) fail("has a header that is too long");
    const auto line = stream_.line(1 << 16);
    if (!line) fail("ends within the header");
    const std::vector<std::string> words = words_of(*line);
    if (words.empty() || words[0].front() == '#') return false;
    const std::string& keyword = words[0];
    if (keyword == "FIELDS" || keyword == "COLUMNS") {
      if (words.size() > kMaxFields) fail("has too many fields");
      for (size_t i = 1; i < words.size(); ++i) header_.fields.push_back({.name = words[i]});
    } else if (keyword == "SIZE" || keyword == "TYPE" || keyword == "COUNT") {
      if (words.size() != header_.fields.size() + 1)
        fail("has a line " + keyword + " that is not a word for each field");
      for (size_t i = 1; i < words.size(); ++i) describe(keyword, words[i], &header_.fields[i - 1]);
    } else if (keyword == "WIDTH") {
      width_ = only_number(words, uint64_t(1) << 31);
    } else if (keyword == "HEIGHT") {
      height_ = only_number(words, uint64_t(1) << 31);
    } else if (keyword == "POINTS") {
      header_.points = only_number(words, uint64_t(1) << 62);
      has_points_ = true;
    } else if (keyword == "DATA") {
      set_data(words);
      return true;
    }
    return false;
  }

  void set_data(const std::vector<std::string>& words) {
    const std::string kind = words.size() == 2 ? words[1] : "";
    if (kind == "binary_compressed")
      fail("is compressed: convert it with pcl_convert_pcd_ascii_binary FILE OUT 1");
    if (kind != "ascii" && kind != "binary") fail("has DATA that is not ascii or binary");
    header_.is_text = kind == "ascii";
  }

  void describe(const std::string& keyword, const std::string& word, PcdField* field) const {
    if (keyword == "TYPE") {
      if (word != "F" && word != "I" && word != "U") fail("has a TYPE that is not F, I or U");
      field->type = word[0];
    } else if (keyword == "SIZE") {
      field->bytes = number(word, 8);
      if (!std::has_single_bit(field->bytes)) fail("has a SIZE that is not 1, 2, 4 or 8");
    } else {
      field->count = number(word, kMaxCount);
    }
  }

  uint64_t only_number(const std::vector<std::string>& words, uint64_t max) const {
    if (words.size() != 2) fail("has a line " + words[0] + " that is not one number");
    return number(words[1], max);
  }
  uint64_t number(const std::string& word, uint64_t max) const {
    uint64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc{} || stop != end || value > max)
      fail("has the count \"" + word.substr(0, 40) + "\" in its header");
    return value;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    fail_input(stream_.file().path(), sentence + " (line " + std::to_string(header_.lines) + ")");
  }

  ByteStream stream_;
  PcdHeader header_;
  uint64_t width_ = 0, height_ = 1;
  bool has_points_ = false;
};

PointColour colour_of_bits(uint32_t rgb) {
  PointColour colour;
  for (size_t c = 0; c < 3; ++c) colour[c] = uint16_t((rgb >> (16 - 8 * c) & 255) * 257);
  return colour;
}

class PcdCloud final : public PointCloud {
 public:
  PcdCloud(const File& file, PcdHeader header) : file_(file), header_(std::move(header)) {
    for (size_t a = 0; a < 3; ++a) {
      const std::string name(1, char('x' + a));
      const PcdField* const field = find(name);
      if (field == nullptr || !is_coordinate(*field))
        fail_input(file.path(),
                   "has no field \"" + name + "\" of one float, double or integer of 4 bytes");
      axes_[a] = *field;
    }
    for (const char* const name : {"rgb", "rgba"}) {
      const PcdField* const field = find(name);
      if (field == nullptr || field->bytes != 4 || field->count != 1) continue;
      colour_ = *field;
      has_colours = true;
    }
  }

  uint64_t read(const PointSink& sink) const override {
    PointCollector out(sink);
    header_.is_text ? read_text(&out) : read_binary(&out);
    return out.finish();
  }

 private:
  const PcdField* find(const std::string& name) const {
    const auto found = std::ranges::find(header_.fields, name, &PcdField::name);
    return found == header_.fields.end() ? nullptr : &*found;
  }
  static bool is_coordinate(const PcdField& field) {
    return field.count == 1 && (field.bytes == 4 || (field.bytes == 8 && field.type == 'F'));
  }

  void read_binary(PointCollector* out) const {
    ByteStream stream(file_, header_.body);
    for (uint64_t left = header_.points; left > 0; --left) {
      const std::byte* const row = stream.peek(header_.row).data();
      if (stream.remaining() < header_.row)
        fail_input(file_.path(), "ends within a point", stream.offset());
      Point point;
      for (size_t a = 0; a < 3; ++a) point[int(a)] = binary_value(row + axes_[a].first, axes_[a]);
      if (out->add(point) && has_colours)
        out->add_colour(colour_of_bits(load_little<uint32_t>(row + colour_.first)));
      stream.skip(header_.row);
    }
  }
  static double binary_value(const std::byte* p, const PcdField& field) {
    if (field.bytes == 8) return load_little<double>(p);
    if (field.type == 'F') return load_little<float>(p);
    return field.type == 'I' ? double(load_little<int32_t>(p)) : double(load_little<uint32_t>(p));
  }

  void read_text(PointCollector* out) const {
    ByteStream stream(file_, header_.body);
    TextScanner text(&stream, {}, header_.lines + 1);
    for (uint64_t left = header_.points; left > 0; --left) {
      Point point;
      uint32_t rgb = 0;
      text.at_end();
      for (uint64_t i = 0; i < header_.row; ++i) {
        const auto axis = std::ranges::find(axes_, i, &PcdField::first);
        if (axis != axes_.end()) {
          const bool is_single = axis->type == 'F' && axis->bytes == 4;
          point[int(axis - axes_.begin())] = is_single ? double(text.number32()) : text.number();
        } else if (has_colours && i == colour_.first) {
          rgb = text_colour(&text);
        } else {
          if (text.word().empty()) text.fail("has a point with too few values");
        }
      }
      if (out->add(point) && has_colours) out->add_colour(colour_of_bits(rgb));
    }
  }
  uint32_t text_colour(TextScanner* text) const {
    if (colour_.type == 'F') return std::bit_cast<uint32_t>(text->number32());
    return uint32_t(text->integer());
  }

  const File& file_;
  PcdHeader header_;
  std::array<PcdField, 3> axes_;
  PcdField colour_;
};

}  // namespace

std::unique_ptr<PointCloud> open_pcd(const File& file) {
  return std::make_unique<PcdCloud>(file, PcdHeaderParser(file).parse());
}

}  // namespace svdag
