// Decodes version 1 of the vertex codec of KHR_meshopt_compression, which the meshoptimizer library
// knows from 0.23 on; distributions have 0.18, which knows version 0.
//
// Vertices are coded in blocks. Byte b of all vertices of a block is one stream: 2 control bits say
// whether it is left out (zeros), stored, or packed in groups of 16 values of 0, 1, 2, 4 or 8 bits,
// where the largest code means that the value is a byte after the group. A stream holds differences
// to the vertex before: per byte, per 16 bits, or as the xor of rotated 32 bits; the tail of the
// data says which, for each 4 bytes, and holds the vertex before the first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace svdag {

// Whether these are vertices in version 1.
bool is_meshopt_version_1(std::span<const std::byte> data);

// Fills `out`, vertices of `stride` bytes (a multiple of 4, at most 256). Returns false for damaged
// data.
bool decode_meshopt_vertices(std::span<const std::byte> data, uint64_t stride,
                             std::span<std::byte> out);

}  // namespace svdag
