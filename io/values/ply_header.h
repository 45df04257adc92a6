// The header of a PLY file (Turk 1994): which elements follow, how many, with which properties.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "streaming/file/byte_stream.h"

namespace svdag {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
  return type < PlyType::kFloat32;
}

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  // set: a list, its length stored before its items

  bool is_list() const { return count_type.has_value(); }
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;

  // The number of the property `name`, or nothing.
  std::optional<size_t> find(const std::string& property) const;
  bool has_lists() const;
  // Bytes of one row in a binary file, if all lists are empty.
  uint64_t least_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  uint64_t lines = 0;          // of the header; the body begins in the next
  uint64_t unknown_lines = 0;  // of these, skipped
};

// Reads the header and leaves `stream` at the first byte of the body.
PlyHeader read_ply_header(ByteStream* stream);

// Whether a PLY file has vertices, but neither faces nor triangle strips.
bool is_point_cloud(const File& file);

}  // namespace svdag
