// The arrays of NumPy's `.npy` files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/formats/voxels/zip.h"
#include "io/triangle.h"
#include "streaming/file/byte_stream.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr std::string_view kNpyMagic = "\x93NUMPY";

// An array in a file: its type, its shape and the offsets of its elements.
struct NpyArray {
  char kind = 0;       // 'b' bool, 'u', 'i', 'f'; texts: 'U' of code points, 'S' of bytes; 0: of an
                       // unsupported type, other members are unset
  uint64_t bytes = 0;  // of an element
  bool big_endian = false;
  bool fortran_order = false;
  std::vector<uint64_t> shape;
  uint64_t offset = 0, end = 0;

  uint64_t elements() const {
    uint64_t n = 1;
    for (const uint64_t side : shape) n *= side;
    return n;
  }
};

// Reads the header of the array at `offset`. What is not one, or is larger than the file up to
// `end`, is an Error (kBadInput).
NpyArray read_npy_header(const File& file, uint64_t offset, uint64_t end);

bool is_integer(const NpyArray& array);
inline bool is_text(const NpyArray& array) {
  return array.kind == 'U' || array.kind == 'S';
}

// Reads the next integer of the array; a negative one of any width becomes a large number.
uint64_t read_integer(ByteStream* stream, const NpyArray& array);

// Begins an archive entry: an array of this type and shape, in NumPy's notation. Its elements
// follow in C order.
void begin_array(ZipWriter* zip, const std::string& name, const std::string& type,
                 const std::string& shape);
// The arrays `corner` (3 x float64) and `voxel_size` (float64).
void put_placement(ZipWriter* zip, const Point& corner, double voxel_size);

}  // namespace svdag
