// The header of a SymVox `.svdag`: files without a magic number that share our ending.
//
// They lack our magic number, and differ from all other files by their fields, which must be
// consistent with each other and with the file's size.
#pragma once

#include <cstdint>

#include "streaming/file/file.h"

namespace svdag {

#pragma pack(push, 1)
struct SymvoxHeader {
  float box_min[3], box_max[3];  // of the scene; the root cube has the same centre
  float side;                    // of the root cube
  uint32_t levels;               // log2 N
  uint32_t nodes;
  uint32_t first_leaf;  // word of the first 2^3 mask (one writer: the count of words)
  uint32_t words;       // u32 each, behind the header
};
#pragma pack(pop)
static_assert(sizeof(SymvoxHeader) == 44);

// Whether `file` is one, as far as its header says; *header is it then.
bool read_symvox_header(const File& file, SymvoxHeader* header);

// If `file` is one: an Error (kBadInput) that names `svdag import`.
void refuse_symvox(const File& file);

}  // namespace svdag
