// The colours of the cubes of a file, as they are stored, for files that are made of it
// (io/dag/colours/kept_colours.h).
//
// A file with a part of the voxels has a cube unchanged if and only if the cube has as many colours
// there: a part of the same size is the whole.
#pragma once

#include <optional>
#include <span>

#include "io/dag/colours/dag_colours.h"

namespace svdag {

class StoredCubes {
 public:
  // `is_whole_part`: the other file has the same level K, and no voxel that this one lacks. Else no
  // cube is unchanged. `file` and its colours must outlive this.
  StoredCubes(const DagFile& file, const DagColours& colours, bool is_whole_part)
      : header_(file.header()),
        view_(colours.view()),
        tables_(colours.tables()),
        is_whole_part_(is_whole_part) {}

  // The number of the first colour of a cube of level 0 .. K, which has `colours` colours in the
  // other file; nothing if it has others here.
  std::optional<uint64_t> unchanged(uint32_t level, uint64_t morton, uint64_t colours) const;
  uint32_t colour(uint64_t number) const { return colour_at(view_, number); }
  // The words of the chunk of exactly these colours; empty if there is none.
  std::span<const uint32_t> chunk(uint64_t number, uint64_t colours) const;

 private:
  const Header& header_;
  const ColourView& view_;
  const ColourCountTables& tables_;
  const bool is_whole_part_;
};

}  // namespace svdag
