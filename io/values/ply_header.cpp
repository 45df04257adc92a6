#include "io/values/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "io/values/text_scan.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Longer headers are hostile; the parsed form of a shorter one stays below a few MiB.
constexpr uint64_t kMaxLines = 1 << 14;
constexpr size_t kLongestLine = 1 << 14;

struct TypeName {
  std::string_view old_name, new_name;
  size_t bytes;
};
constexpr std::array<TypeName, 8> kTypes = {{{"char", "int8", 1},
                                             {"uchar", "uint8", 1},
                                             {"short", "int16", 2},
                                             {"ushort", "uint16", 2},
                                             {"int", "int32", 4},
                                             {"uint", "uint32", 4},
                                             {"float", "float32", 4},
                                             {"double", "float64", 8}}};

class HeaderParser {
 public:
  explicit HeaderParser(ByteStream* stream) : stream_(stream) {}

  PlyHeader parse() {
    if (next_line() != std::vector<std::string>{"ply"}) fail("does not begin with \"ply\"");
    bool has_format = false;
    for (;;) {
      const std::vector<std::string> words = next_line();
      const std::string keyword = words.empty() ? "" : words[0];
      if (keyword == "end_header") break;
      if (keyword == "format") {
        header_.format = format(words);
        has_format = true;
      } else if (keyword == "element") {
        add_element(words);
      } else if (keyword == "property") {
        add_property(words);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        ++header_.unknown_lines;
      }
    }
    if (!has_format) fail("has a header without \"format\"");
    return std::move(header_);
  }

 private:
  std::vector<std::string> next_line() {
    if (++header_.lines > kMaxLines) fail("has a header that is too long");
    auto line = stream_->line(kLongestLine);
    if (!line) fail("ends within the header");
    if (header_.lines == 1 && line->starts_with(kByteOrderMark))
      line->remove_prefix(kByteOrderMark.size());
    if (line->find('\0') != line->npos) fail("has a byte of 0 in its header");
    return words_of(*line);
  }

  PlyFormat format(const std::vector<std::string>& words) const {
    if (words.size() != 3 || words[2] != "1.0") fail("is not a PLY file of version 1.0");
    if (words[1] == "ascii") return PlyFormat::kAscii;
    if (words[1] == "binary_little_endian") return PlyFormat::kLittleEndian;
    if (words[1] == "binary_big_endian") return PlyFormat::kBigEndian;
    fail("has the unknown format \"" + words[1].substr(0, 40) + "\"");
  }

  void add_element(const std::vector<std::string>& words) {
    if (words.size() != 3) fail("has a header line that is not \"element NAME COUNT\"");
    PlyElement element{words[1], 0, {}};
    const std::string& digits = words[2];
    const char* end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, element.count);
    if (error != std::errc{} || stop != end)
      fail("has \"" + digits.substr(0, 40) + "\" as the number of elements");
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) fail("has two elements \"" + other.name.substr(0, 40) + "\"");
    }
    header_.elements.push_back(std::move(element));
  }

  void add_property(const std::vector<std::string>& words) {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3)
      fail("has a header line that is not \"property [list TYPE] TYPE NAME\"");
    if (header_.elements.empty()) fail("has a property before the first element");
    PlyProperty property{words.back(), type(words[words.size() - 2]), {}};
    if (list) {
      property.count_type = type(words[2]);
      if (!is_integer(*property.count_type)) fail("has a list whose length is not an integer");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type(const std::string& name) const {
    for (size_t i = 0; i < kTypes.size(); ++i) {
      if (name == kTypes[i].old_name || name == kTypes[i].new_name) return PlyType(i);
    }
    fail("has the unknown property type \"" + name.substr(0, 40) + "\"");
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    fail_input(stream_->file().path(), sentence + " (line " + std::to_string(header_.lines) + ")");
  }

  ByteStream* stream_;
  PlyHeader header_;
};

}  // namespace

size_t size_of(PlyType type) {
  return kTypes[size_t(type)].bytes;
}

std::optional<size_t> PlyElement::find(const std::string& property) const {
  for (size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return i;
  }
  return {};
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list(); });
}

uint64_t PlyElement::least_bytes() const {
  uint64_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.is_list() ? *property.count_type : property.type);
  return bytes;
}

PlyHeader read_ply_header(ByteStream* stream) {
  return HeaderParser(stream).parse();
}

bool is_point_cloud(const File& file) {
  ByteStream stream(file);
  uint64_t vertices = 0;
  for (const PlyElement& element : read_ply_header(&stream).elements) {
    if (element.name == "vertex") vertices = element.count;
    if ((element.name == "face" || element.name == "tristrips") && element.count > 0) return false;
  }
  return vertices > 0;
}

}  // namespace svdag
