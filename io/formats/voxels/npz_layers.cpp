#include "io/formats/voxels/npz_layers.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <unordered_set>

#include "streaming/error.h"

namespace svdag {
namespace {

constexpr uint64_t kMaxNameBytes = uint64_t(64) << 20;  // of all names

[[noreturn]] void fail(const File& file, const char* name, const char* sentence) {
  fail_input(file.path(), std::string("has an array \"") + name + "\" " + sentence);
}

// Appends a code point as UTF-8; returns false if it is not valid.
bool put_utf8(uint32_t code, std::string* text) {
  if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
  const auto put = [&](uint32_t byte) { *text += char(byte); };
  const auto put_rest = [&](int shift) { put(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | code >> 6);
    put_rest(0);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12);
    put_rest(6);
    put_rest(0);
  } else {
    put(0xf0 | code >> 18);
    for (const int shift : {12, 6, 0}) put_rest(shift);
  }
  return true;
}

// An element of an array of texts, which is padded with zeros.
std::string text_of(const File& file, const char* name, std::string_view element, bool is_unicode) {
  const size_t unit = is_unicode ? sizeof(uint32_t) : 1;
  std::string text;
  size_t end = 0;  // of the text without the padding
  for (size_t at = 0; at < element.size(); at += unit) {
    uint32_t code = 0;
    std::memcpy(&code, element.data() + at, unit);
    if (!is_unicode) text += element[at];
    if (is_unicode && !put_utf8(code, &text)) fail(file, name, "that is not valid Unicode");
    if (code != 0) end = text.size();
  }
  text.resize(end);
  if (text.find('\0') != std::string::npos) fail(file, name, "with a zero inside a text");
  return text;
}

// The texts of an array of them, or of bytes with a zero after each text.
std::vector<std::string> read_texts(const File& file, const char* name, const NpyArray& array) {
  const bool is_row = array.shape.size() <= 1 && (is_text(array) || array.kind == 'u');
  if (!is_row || (!is_text(array) && array.bytes != 1) ||
      array.elements() > kMaxNameBytes / array.bytes)
    fail(file, name, "that is not a row of texts, or of uint8, of at most 64 MiB");
  std::string bytes(array.elements() * array.bytes, '\0');
  ByteStream(file, array.offset, array.end).read(std::as_writable_bytes(std::span(bytes)));
  std::vector<std::string> texts;
  for (std::string_view rest = bytes; !rest.empty();) {
    size_t size = array.bytes;
    if (is_text(array)) {
      texts.push_back(text_of(file, name, rest.substr(0, size), array.kind == 'U'));
    } else {
      const size_t end = rest.find('\0');
      if (end == std::string_view::npos) fail(file, name, "that does not end with a zero byte");
      texts.emplace_back(rest.substr(0, end));
      size = end + 1;
    }
    if (texts.size() > kMaxLayers) fail_many_layers(file.path());
    rest.remove_prefix(size);
  }
  return texts;
}

LayerKind read_kind(const File& file, const NpyArray& array) {
  const std::vector<std::string> texts = read_texts(file, "layer_kind", array);
  for (size_t kind = 1; kind < std::size(kLayerKindNames); ++kind) {
    if (texts.size() == 1 && texts.front() == kLayerKindNames[kind]) return LayerKind(kind);
  }
  fail(file, "layer_kind", "that is not object, material, file or frame");
}

void read_names(const File& file, const NpyArray& array, LayerTable* table) {
  std::unordered_set<std::string> seen;
  for (std::string& name : read_texts(file, "layer_names", array)) {
    if (!seen.insert(name).second)
      fail_input(file.path(),
                 "two layers are named " + shown_layer(name) + " (--no-layers ignores them)");
    const Colour colour = palette_colour(name);
    table->layers.push_back({std::move(name), colour});
  }
}

void read_colours(const File& file, const NpyArray& array, LayerTable* table) {
  if (!is_integer(array) || array.shape.size() != 1 || array.elements() != table->layers.size())
    fail(file, "layer_colours", "that is not an integer for each layer");
  ByteStream stream(file, array.offset, array.end);
  for (Layer& layer : table->layers) {
    const uint64_t colour = read_integer(&stream, array);
    if (colour > 0xffffff) fail(file, "layer_colours", "that is not of colours 0xRRGGBB");
    layer.colour = {uint8_t(colour >> 16), uint8_t(colour >> 8), uint8_t(colour)};
  }
}

}  // namespace

NpzLabels read_npz_layers(const File& file, const NpzLayerArrays& arrays, uint64_t voxels,
                          LayerTable* table) {
  const NpyArray& label = *arrays.label;
  if (!is_integer(label) || label.shape.size() != 1 || label.elements() != voxels)
    fail(file, "label",
         "that is not an integer for each row of \"coordinates\" (--no-layers ignores it)");
  table->kind = arrays.kind ? read_kind(file, *arrays.kind) : LayerKind::kMaterial;
  if (!arrays.names) return {file, label, std::nullopt, table};
  read_names(file, *arrays.names, table);
  if (arrays.colours) read_colours(file, *arrays.colours, table);
  return {file, label, table->layers.size(), table};
}

}  // namespace svdag
