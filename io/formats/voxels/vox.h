// Reader and writer of MagicaVoxel files `.vox`: models of up to 256^3 voxels, placed by a scene
// graph.
//
// Layout: "VOX ", u32 150, and chunks: 4 letters, u32 bytes, u32 bytes of inner chunks. MAIN holds
// SIZE (3 x u32) and XYZI (u32 n, n x {x, y, z, colour} bytes) per model, then the scene graph:
// nTRN (translation), nGRP (group), nSHP (shape). A model is placed by the position of its voxel
// size/2. RGBA (256 x {r, g, b, a}) holds the colours from 1 on; without it, they are MagicaVoxel's
// default palette. A window is written as tiles of 256^3 without the empty ones. Axes are not
// swapped (z is up in MagicaVoxel). Every voxel has colour 1, white; with layers, the colour 1 +
// the number of its layer, and RGBA (256 x {r, g, b, 255}) the colours from 1 on; the one after the
// last layer's is for voxels of no layer. World coordinates are not stored.
#pragma once

#include <string>

#include "io/dag/layers/layer_table.h"
#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

constexpr uint64_t kMaxVoxModels = 4096;
constexpr uint64_t kMaxVoxVoxels = uint64_t(1) << 29;  // chunks have 32-bit sizes

constexpr size_t kMaxVoxLayers = 255;

// More tiles, voxels or layers are an Error (kUsage).
void write_vox(const VoxelWindow& window, const std::string& path);

// Rotated models are not supported. If coordinates are negative, all voxels are shifted so that the
// minimum is 0. Any other file is an Error (kBadInput). `layers`, which is empty, gets a layer for
// each colour in use, except for a file without palette whose voxels have one colour; null: the
// colours are ignored.
GridPlacement read_vox(const File& file, const VoxelSink& sink, LayerTable* layers);

}  // namespace svdag
