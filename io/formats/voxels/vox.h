// Reader and writer of MagicaVoxel files `.vox`: models of up to 256^3 voxels, placed by a scene
// graph.
//
// Layout: "VOX ", u32 150, and chunks: 4 letters, u32 bytes, u32 bytes of inner chunks. MAIN holds
// SIZE (3 x u32) and XYZI (u32 n, n x {x, y, z, colour} bytes) per model, then the scene graph:
// nTRN (translation), nGRP (group), nSHP (shape). A model is placed by the position of its voxel
// size/2. RGBA (256 x {r, g, b, a}) holds the colours from 1 on; without it, they are MagicaVoxel's
// default palette. A window is written as tiles of 256^3 without the empty ones. z is up in
// MagicaVoxel: the axis that is up in the grid becomes z, by a rotation about the grid's corner,
// which reading undoes exactly. Every voxel has colour 1, white; with stored colours, one of a
// palette (io/formats/voxels/colour_palette.h); with layers only, 1 + the number of its layer, and
// the one after the last layer's for voxels of no layer. Then RGBA (256 x {r, g, b, 255}) is
// written. World coordinates are not stored.
#pragma once

#include <array>
#include <string>

#include "io/dag/layers/layer_table.h"
#include "io/formats/voxels/colour_palette.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr uint64_t kMaxVoxModels = 4096;
constexpr uint64_t kMaxVoxVoxels = uint64_t(1) << 29;  // chunks have 32-bit sizes

constexpr int kDefaultVoxUp = 1;  // y, as in scenes

// A rotation by quarter turns, mirrored or not: axis a comes from axis from[a], backwards if
// flip[a].
struct VoxTurn {
  std::array<uint8_t, 3> from{0, 1, 2};
  std::array<bool, 3> flip{};

  // This turn after `first`.
  VoxTurn after(const VoxTurn& first) const {
    VoxTurn both;
    for (size_t a = 0; a < 3; ++a) {
      both.from[a] = first.from[from[a]];
      both.flip[a] = flip[a] != first.flip[from[a]];
    }
    return both;
  }
  VoxTurn inverse() const {
    VoxTurn back;
    for (size_t a = 0; a < 3; ++a) {
      back.from[from[a]] = uint8_t(a);
      back.flip[from[a]] = flip[a];
    }
    return back;
  }
  template <class Vector>
  std::array<int64_t, 3> of(const Vector& point) const {
    std::array<int64_t, 3> turned;
    for (size_t a = 0; a < 3; ++a) turned[a] = flip[a] ? -point[from[a]] : point[from[a]];
    return turned;
  }
};

// The turn that brings axis `up` (0: x, 1: y, 2: z) to z. No axis is mirrored.
constexpr VoxTurn vox_turn(int up) {
  if (up == 0) return {{1, 2, 0}, {}};
  if (up == 1) return {{0, 2, 1}, {false, true, false}};
  return {};
}

// `up`: the axis of the grid that is up. `palette`: of stored colours; null: there are none. More
// tiles, voxels or layers are an Error (kUsage).
void write_vox(const VoxelWindow& window, const ColourPalette* palette, const std::string& path,
               int up);

// `up`: the axis of the grid that z becomes. If coordinates are negative, all voxels are shifted so
// that the minimum is 0. Any other file is an Error (kBadInput). `layers`, which is empty, gets a
// layer for each colour in use; null: there are none. `with_colours`: voxels have colours. A file
// without palette whose voxels have one number has neither.
GridPlacement read_vox(const File& file, const VoxelSink& sink, LayerTable* layers,
                       bool with_colours, int up);

}  // namespace svdag
