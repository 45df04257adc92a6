// A tile as bytes: what the page loads, gzip around little-endian u32 words.
//
//   0       "SVT1"
//   1       FNV-1a over the words after this one
//   2       T
//   3       layer root, a value
//   4       words of the layer nodes
//   5       words of the sets
//   6..21   ids of the octants' tiles, each low word and high word
//   22..    words of each section, T-1 numbers
//   then    the sections; the layer nodes; the sets, each its size and its members
//
// The page decompresses it with the browser's own code, so any web server can hold it. The words
// of a tile are a function of the tile; the bytes depend on the version of zlib as well.
#pragma once

#include <span>
#include <string>

#include "verify/view/tile.h"

namespace svdag {

std::vector<uint32_t> words_of(const DagTile& tile);
std::string encode_tile(const DagTile& tile);
// The words as one gzip member: how colours are sent, too.
std::string compressed(std::span<const uint32_t> words);

// The tile of `words`; nothing if they are not exactly those of a valid tile: an offset that is not
// a node's in the next section, a node or set that repeats or that nothing refers to, a value
// out of range.
std::optional<DagTile> tile_of_words(std::span<const uint32_t> words);
// The same for bytes, with memory of at most 1,032 times as many, as gzip allows.
std::optional<DagTile> decode_tile(std::span<const std::byte> bytes);

}  // namespace svdag
