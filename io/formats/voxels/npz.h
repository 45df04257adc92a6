// Reader and writer of NumPy archives `.npz` with the coordinates of set voxels.
//
// An archive is a zip file of uncompressed `.npy` arrays. Written: `coordinates` (N x 3, int32: x,
// y, z from the corner of the grid, in any order), `resolution` (int64), `corner` (3 x float64,
// world position of the corner of voxel (0, 0, 0)) and `voxel_size` (float64). With colours also
// `colours` (N x 3, uint8: red, green, blue, sRGB). With layers also
// `label` (N, uint16: the number of each voxel's layer, 0xffff for voxels of no layer), and of each
// layer `layer_colours` (uint32, 0xRRGGBB) and `layer_names` (bytes; a zero byte after each name);
// `layer_kind` (the same) is what a layer is.
// Read: the same, or any archive (or single `.npy`) with one array of N x 3 integers, or one
// 3-dimensional array of bool or uint8, whose nonzero elements are set. `resolution` and
// `voxel_size` hold one number, `corner` three, as float32, float64 or integers of 1 to 8 bytes;
// any other array of these names is rejected, and so are compressed archives. `colours` (N x 3,
// uint8) is of the rows of the coordinates; an array of another type is ignored. `label` has an
// integer for each row of the coordinates. Without names each number is a layer; names may also be
// an array of texts. Without colours, the names choose them.
#pragma once

#include <string>

#include "io/dag/layers/layer_table.h"
#include "io/formats/window.h"
#include "streaming/file/file.h"

namespace svdag {

void write_npz(const VoxelWindow& window, const std::string& path);

// Any other file is an Error (kBadInput), and so is a coordinate outside 0 .. 2^20 - 1. `layers`,
// which is empty, gets the layers; null: labels are ignored. `with_colours`: voxels have colours.
GridPlacement read_npz(const File& file, const VoxelSink& sink, LayerTable* layers,
                       bool with_colours);

}  // namespace svdag
