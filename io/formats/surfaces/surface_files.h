// Writers of surfaces, tile by tile: GLB, OBJ, PLY and STL.
//
// GLB holds voxel planes as whole numbers, which are exact in its floats, and a node that places
// them in the world; colours are linear, 16 bits a channel. OBJ and PLY hold coordinates of the
// world in full precision, with sRGB colours of vertices; STL holds them as floats, without
// colours. GLB and PLY have all vertices before the first face: faces wait in a file without a
// name, beside the output.
#pragma once

#include <string>

#include "io/formats/surfaces/surface.h"

namespace svdag {

struct SurfaceFileConfig {
  SurfaceConfig surface;
  uint64_t max_quads = 0;  // more are an Error (kUsage) with their number, and no file is written
};

using WriteSurface = SurfaceCounts(const VoxelWindow& window, const SurfaceFileConfig& config,
                                   const std::string& path);
// What does not fit into GLB (4 GiB), or STL and PLY (2^32 triangles and vertices), is an Error
// (kUsage).
WriteSurface write_surface_glb, write_surface_obj, write_surface_ply, write_surface_stl;

}  // namespace svdag
