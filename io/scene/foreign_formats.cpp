#include "io/scene/foreign_formats.h"

#include <algorithm>

namespace svdag {
namespace {

constexpr const char* kByBlender = "open it in Blender and export it as .glb";
constexpr const char* kByMeshLab = "convert it to .ply, for example with MeshLab or Open3D";

struct Foreign {
  std::string_view extensions;  // separated by spaces, with one at both ends
  std::string_view start;       // the file's first bytes; empty: only the extension tells
  const char* name;
  const char* advice;
};

constexpr Foreign kForeign[] = {
    {" blend ", "BLENDER", "Blender", kByBlender},
    {" abc ", "Ogawa", "Alembic", kByBlender},
    {" usd usda ", "#usda", "USD", kByBlender},
    {" usdz ", "", "a USD archive", kByBlender},
    {" usdc ", "PXR-USDC", "USD", kByBlender},
    {" step stp iges igs ", "ISO-1030", "a CAD model",
     "tessellate it, for example with FreeCAD, and export it as .stl"},
    {" vrml wrl x3d ", "#VRML", "VRML or X3D", kByMeshLab},
    {" las laz ", "LASF", "a point cloud (LAS)",
     "svdag bakes triangles: reconstruct a surface first, for example with CloudCompare"},
    {" e57 pcd xyz pts ", "ASTM-E57", "a point cloud",
     "svdag bakes triangles: reconstruct a surface first, for example with CloudCompare"},
    {" splat spz ", "", "a Gaussian splat", "svdag bakes triangles: extract a mesh first"},
    {" zst ", "\x28\xb5\x2f\xfd", "compressed with zstd", "unpack it with unzstd"},
    {" zip ", "PK\x03\x04", "a ZIP archive", "unpack it and name the scene in it"},
    {" vdb ", " BDV", "an OpenVDB grid", "svdag import reads its voxels"},
    {" npz npy binvox vox ", "", "a voxel file", "svdag import reads its voxels"},
};

}  // namespace

std::string foreign_format_message(std::string_view extension, std::string_view start) {
  const std::string word = " " + std::string(extension) + " ";
  for (const Foreign& each : kForeign) {
    const bool by_name = !extension.empty() && each.extensions.find(word) != std::string_view::npos;
    const size_t length = std::min(start.size(), each.start.size());
    const bool by_start = length >= 2 && each.start.substr(0, length) == start.substr(0, length);
    if (by_name || by_start)
      return std::string("is ") + each.name + ", which svdag does not read: " + each.advice;
  }
  return "";
}

}  // namespace svdag
