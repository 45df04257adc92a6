// The header of a SymVox file, a format that also uses the name extension `.svdag`.
//
// It has no magic number. A file is recognized by header fields that are consistent with one
// another and with the file size.
#pragma once

#include <cstdint>

#include "streaming/file/file.h"

namespace svdag {

#pragma pack(push, 1)
struct SymvoxHeader {
  float box_min[3], box_max[3];  // box of the scene; the root cube has the same centre
  float side;                    // of the root cube
  uint32_t levels;               // log2 N
  uint32_t nodes;
  uint32_t first_leaf;  // word of the first 2^3 mask (one writer stores the number of words)
  uint32_t words;       // u32 each, after the header
};
#pragma pack(pop)
static_assert(sizeof(SymvoxHeader) == 44);

// Whether `file` has a valid SymVox header; if so, it is stored in *header.
bool read_symvox_header(const File& file, SymvoxHeader* header);

// Error (kBadInput) that points to `svdag import` if `file` is a SymVox file.
void reject_symvox(const File& file);

}  // namespace svdag
