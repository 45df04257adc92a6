// Colours of sets of voxels by definition: a synthetic source for the writer, and what every cube
// must show, by maps instead of counts.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "io/dag/colours/colour_writer.h"
#include "tests/io/dag/colours/colour_rows.h"
#include "tests/voxel_sets.h"

namespace svdag {

// What the triangles of a cube give it.
struct GivenColour {
  bool has_colour = true;
  bool is_constant = false;
  std::array<uint16_t, 3> linear{};
  bool operator==(const GivenColour&) const = default;
};

using ColourOfCube = std::function<GivenColour(int64_t x, int64_t y, int64_t z)>;

inline uint64_t morton_code(int64_t x, int64_t y, int64_t z) {
  uint64_t code = 0;
  for (int bit = 0; bit < 20; ++bit)
    code |= (uint64_t(x >> bit & 1) << 2 | uint64_t(y >> bit & 1) << 1 | uint64_t(z >> bit & 1))
            << 3 * bit;
  return code;
}

// Cubes of one level by Morton code.
using ColouredCubes = std::map<uint64_t, GivenColour>;

inline ColouredCubes coloured_cubes(const VoxelSet& voxels, int levels, int level,
                                    const ColourOfCube& colour) {
  ColouredCubes cubes;
  for (const auto& [x, y, z] : voxels) {
    const int shift = levels - level;
    cubes.try_emplace(morton_code(x >> shift, y >> shift, z >> shift),
                      colour(x >> shift, y >> shift, z >> shift));
  }
  return cubes;
}

// Textures, plain walls, and a solid's inside, in blocks of `side` cubes.
inline ColourOfCube mixed_colours(int64_t side) {
  return [side](int64_t x, int64_t y, int64_t z) {
    const uint64_t block = uint64_t(x / side * 7 + y / side * 3 + z / side) % 5;
    GivenColour given;
    if (block == 0) return GivenColour{true, true, {1000, 20000, 65535}};
    if (block == 1) return GivenColour{true, true, {uint16_t(40000 + 8000 * (x / side)), 3, 77}};
    if (block == 2) return GivenColour{false, false, {}};
    const uint64_t grain = uint64_t(x * 2654435761 + y * 40503 + z * 69069) >> 5;
    for (size_t c = 0; c < 3; ++c)
      given.linear[c] =
          uint16_t(std::min<uint64_t>(65535, uint64_t(x * 300 * int64_t(c) + y * 500 + z * 100) +
                                                 grain % (block == 3 ? 900 : 40000)));
    return given;
  };
}

// The entries of the source; those of equal constant colour are joined to coarser ones, where all
// covered children of a cube have one, `joins` times at most.
inline std::vector<CubeColour> source_of(const ColouredCubes& cubes, int level, int joins) {
  std::map<std::pair<uint64_t, int>, GivenColour> entries;  // first cube of level K; level
  for (const auto& [code, colour] : cubes) entries[{code, level}] = colour;
  for (int k = level - 1; k >= 0 && joins-- > 0; --k) {
    std::map<uint64_t, std::vector<std::pair<uint64_t, int>>> children;
    for (const auto& [key, colour] : entries) children[key.first >> 3 * (level - k)].push_back(key);
    for (const auto& [code, keys] : children) {
      const GivenColour colour = entries[keys.front()];
      bool joined = colour.is_constant || !colour.has_colour;
      for (const auto& key : keys) joined = joined && key.second == k + 1 && entries[key] == colour;
      if (!joined) continue;
      for (const auto& key : keys) entries.erase(key);
      entries[{code << 3 * (level - k), k}] = colour;
    }
  }
  std::vector<CubeColour> source;
  for (const auto& [key, colour] : entries)
    source.push_back({key.first >> 3 * (level - key.second),
                      uint8_t(key.second),
                      colour.has_colour,
                      colour.is_constant,
                      {colour.linear[0], colour.linear[1], colour.linear[2]}});
  return source;
}

// Gives them in parts of `size`.
inline CubeColourSource in_parts(const std::vector<CubeColour>& colours, size_t size) {
  return [&colours, size, at = size_t(0)]() mutable {
    const auto part = std::span(colours).subspan(at, std::min(size, colours.size() - at));
    at += part.size();
    return part;
  };
}

// The stored colour, before encoding, of each cube of `level` from those of K: their mean.
inline std::map<uint64_t, uint32_t> expected_colours(const ColouredCubes& cubes, int finest,
                                                     int level) {
  std::map<uint64_t, std::array<uint64_t, 4>> sums;
  for (const auto& [code, colour] : cubes) {
    auto& sum = sums[code >> 3 * (finest - level)];
    if (!colour.has_colour) continue;
    for (size_t c = 0; c < 3; ++c) sum[c] += colour.linear[c];
    ++sum[3];
  }
  std::map<uint64_t, uint32_t> colours;
  for (const auto& [code, sum] : sums) {
    uint32_t& colour = colours[code] = sum[3] == 0 ? kNoColour : 0;
    for (size_t c = 0; c < 3 && sum[3] > 0; ++c)
      colour |= uint32_t(srgb_code(uint16_t((2 * sum[c] + sum[3]) / (2 * sum[3])))) << 8 * c;
  }
  return colours;
}

}  // namespace svdag
