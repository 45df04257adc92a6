// Writes a `.svdag` file with colours (docs/format.md, "Colours") from one without, and back.
//
// The definition of the entries: a cube of level K is uniform if its triangles have one constant
// colour, or it has no colour; a coarser one if its covered cubes are, with the same stored colour.
// A maximal uniform cube is one entry, whatever its number of colours, unless it is in a chunk. A
// chunk is a maximal cube that is not uniform and has at most 16,384 colours, those of its means
// included (so that a number in a chunk has 14 bits: a cube of few voxels may have many means).
// Other cubes of the levels K-2, K-4, ... are an entry each. So the entries depend on the voxels
// and the colours only, not on the parts in which those arrive.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>

#include "io/dag/colours/cube_colour.h"
#include "io/dag/colours/dag_copy.h"
#include "io/dag/colours/stored_cubes.h"
#include "io/dag/dag_file.h"
#include "streaming/process/executor.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The stored code, 8 bits of sRGB, of linear light of 16 bits: by 255 thresholds.
uint8_t srgb_code(uint16_t linear);

// Returns the next colours, valid until the next call, in ascending order of their first cube of
// level K; empty at the end.
using CubeColourSource = std::function<std::span<const CubeColour>()>;

struct ColourSettings {
  uint32_t level = 0;                     // K, 1 .. L
  uint32_t error = 9 * kColourErrorUnit;  // Header::colour_error; 0 is lossless
};

// Adds these colours to a copy of `dag`. Every covered cube of level K must be in one entry of
// `source`, and no other cube: else Error (kInternal). Error (kUsage) if `dag` has layers without a
// union. Memory: the counts of all nodes, and per worker a few MiB. Same bytes for any number of
// workers.
//
// `stored`: the cubes of the file whose colours these are, decoded. Then chunks and means of its
// unchanged cubes are copied, the other chunks are encoded without error.
void add_colours(DagCopy* copy, const DagFile& dag, const ColourSettings& settings,
                 const CubeColourSource& source, const WorkRoom& room, Executor* executor,
                 const StoredCubes* stored = nullptr);
// Writes `dag` with these colours instead of its own to `path` and returns the header.
Header write_coloured(const DagFile& dag, const ColourSettings& settings,
                      const CubeColourSource& source, const std::string& path, const WorkRoom& room,
                      Executor* executor);

// Copies the colours of a file with the same voxels in any layout.
void add_colours_of(DagCopy* copy, const DagFile& coloured);
Header copy_colours(const DagFile& dag, const DagFile& coloured, const std::string& path);

// Writes a file without its colours: the bytes from before they were added. Error (kBadInput) if
// its content hash is another.
Header write_without_colours(const DagFile& coloured, const std::string& path);
// The same as a file in `folder` without a name.
DagFile without_colours(const DagFile& coloured, const std::string& folder);

}  // namespace svdag
