// The values in the body of a PLY file, one after the other, binary or as text.
//
// Both classes have the same interface, so that the reader is written once as a template: number,
// integer, skip, the position to return to, and the checks of counts against the remaining bytes.
// Functions for both follow: lists, colours, and rows to skip.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "io/values/endian.h"
#include "io/values/ply_header.h"
#include "io/values/text_scan.h"
#include "streaming/error.h"

namespace svdag {

// Position of a value in the file.
struct PlyPlace {
  uint64_t offset = 0;
  uint64_t line = 0;  // text only
};

class PlyBinaryValues {
 public:
  PlyBinaryValues(const File& file, PlyFormat format, PlyPlace from)
      : stream_(file, from.offset),
        order_(format == PlyFormat::kBigEndian ? std::endian::big : std::endian::little) {}

  PlyPlace place() const { return {stream_.offset(), 0}; }
  ByteStream& stream() { return stream_; }
  std::endian order() const { return order_; }

  double number(PlyType type) { return take<double>(type); }
  int64_t integer(PlyType type) { return take<int64_t>(type); }  // of an integer type
  void skip(PlyType type, uint64_t count) {
    if (!may_hold(count, type)) fail("ends too early");
    stream_.skip(count * size_of(type));
  }
  // Whether the rest of the file has room for `count` values, or rows.
  bool may_hold(uint64_t count, PlyType type) const {
    return count <= stream_.remaining() / size_of(type);
  }
  bool may_hold(const PlyElement& element) const {
    return element.count <= stream_.remaining() / element.least_bytes();
  }
  [[noreturn]] void fail(const std::string& sentence) const {
    fail_input(stream_.file().path(), sentence, stream_.offset());
  }

 private:
  template <class T>
  T take(PlyType type) {
    const size_t bytes = size_of(type);
    const std::byte* p = stream_.peek(bytes).data();
    if (stream_.remaining() < bytes) fail("ends too early");
    const T value = value_at<T>(p, type);
    stream_.skip(bytes);
    return value;
  }
  template <class T>
  T value_at(const std::byte* p, PlyType type) const {
    switch (type) {
      case PlyType::kInt8:
        return static_cast<T>(load<int8_t>(p, order_));
      case PlyType::kUint8:
        return static_cast<T>(load<uint8_t>(p, order_));
      case PlyType::kInt16:
        return static_cast<T>(load<int16_t>(p, order_));
      case PlyType::kUint16:
        return static_cast<T>(load<uint16_t>(p, order_));
      case PlyType::kInt32:
        return static_cast<T>(load<int32_t>(p, order_));
      case PlyType::kUint32:
        return static_cast<T>(load<uint32_t>(p, order_));
      case PlyType::kFloat32:
        return static_cast<T>(load<float>(p, order_));
      case PlyType::kFloat64:
        break;
    }
    return static_cast<T>(load<double>(p, order_));
  }

  ByteStream stream_;
  std::endian order_;
};

class PlyTextValues {
 public:
  PlyTextValues(const File& file, PlyFormat, PlyPlace from)
      : stream_(file, from.offset), scanner_(&stream_, {}, from.line) {}
  PlyTextValues(const PlyTextValues&) = delete;  // the scanner points at our stream
  PlyTextValues& operator=(const PlyTextValues&) = delete;

  PlyPlace place() const { return {scanner_.offset(), scanner_.line()}; }

  // Text declared as float is rounded to float, everything else to the nearest double.
  double number(PlyType type) {
    scanner_.at_end();
    return type == PlyType::kFloat32 ? double(scanner_.number32()) : scanner_.number();
  }
  int64_t integer(PlyType) {
    scanner_.at_end();
    return scanner_.integer();
  }
  void skip(PlyType type, uint64_t count) {
    for (; count > 0; --count) number(type);
  }
  // A value takes a digit and a blank, except the last of the file.
  bool may_hold(uint64_t count, PlyType) const { return count <= (scanner_.remaining() + 1) / 2; }
  bool may_hold(const PlyElement& element) const {
    return element.count <= (scanner_.remaining() + 1) / 2 / element.properties.size();
  }
  [[noreturn]] void fail(const std::string& sentence) const { scanner_.fail(sentence); }

 private:
  ByteStream stream_;
  TextScanner scanner_;
};

// The properties of an element that are its colour: red, green and blue.
inline std::optional<std::array<size_t, 3>> colours_of(const PlyElement& element) {
  for (const std::string before : {"", "diffuse_"}) {
    std::array<size_t, 3> colours;
    size_t found = 0;
    for (const char* const name : {"red", "green", "blue"}) {
      const auto index = element.find(before + name);
      if (!index || element.properties[*index].is_list()) break;
      colours[found++] = *index;
    }
    if (found == 3) return colours;
  }
  return {};
}

// 1 is the most that a value of sRGB may be, or of whole numbers the most of 16 bits if the type
// has 16, else of 8.
inline double share_of_range(double value, PlyType type) {
  return value / (!is_integer(type) ? 1 : size_of(type) == 2 ? 65535 : 255);
}

// A count that the rest of the file cannot hold is rejected before it is used.
template <class Values>
void check_count(const Values& values, const PlyElement& element) {
  if (!element.properties.empty() && !values.may_hold(element))
    values.fail("promises " + std::to_string(element.count) + " elements \"" +
                element.name.substr(0, 40) + "\", more than its bytes can hold");
}

template <class Values>
uint64_t list_length(Values& values, const PlyProperty& list) {
  const int64_t length = values.integer(*list.count_type);
  if (length < 0 || !values.may_hold(uint64_t(length), list.type))
    values.fail("has a list of " + std::to_string(length) + " items, which it cannot hold");
  return uint64_t(length);
}

template <class Values>
void skip_property(Values& values, const PlyProperty& property) {
  values.skip(property.type, property.is_list() ? list_length(values, property) : 1);
}

template <class Values>
void skip_rows(Values& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  check_count(values, element);
  if constexpr (std::is_same_v<Values, PlyBinaryValues>) {
    if (!element.has_lists()) return values.stream().skip(element.count * element.least_bytes());
  }
  for (uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) skip_property(values, property);
  }
}

}  // namespace svdag
