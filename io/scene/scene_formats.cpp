#include "io/scene/scene_formats.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "io/scene/decoders/gzip.h"
#include "io/scene/gltf/document/gltf_buffers.h"
#include "io/scene/gltf/document/tile.h"
#include "io/scene/gltf/gltf_animation.h"
#include "io/scene/gltf/gltf_cut_out.h"
#include "io/scene/gltf/gltf_images.h"
#include "io/scene/readers/mtl.h"
#include "io/values/ply_header.h"
#include "io/values/text_scan.h"
#include "streaming/error.h"

namespace svdag {
namespace {

bool begins_as_ply(std::string_view start, bool is_named_stl) {
  const std::string_view after = is_named_stl ? "\r\n" : "\r\n \t";
  return start.starts_with("ply") && after.find(start[3]) != after.npos;
}

bool begins_as_glb(std::string_view start, bool) {
  return start.starts_with(std::string_view("glTF\1\0\0\0", 8)) ||
         start.starts_with(std::string_view("glTF\2\0\0\0", 8));
}

bool begins_as_b3dm(std::string_view start, bool) {
  return begins_as_batched_tile(start);
}

bool begins_as_i3dm(std::string_view start, bool) {
  return begins_as_instanced_tile(start);
}

bool begins_as_draco(std::string_view start, bool is_named_stl) {
  return start.starts_with("DRACO") && !is_named_stl;
}

bool begins_as_fbx(std::string_view start, bool is_named_stl) {
  return start.starts_with("Kaydara") && !is_named_stl;
}

void visit_mtl_files(const File& content, const BesideOptions& options, const VisitFile& visit) {
  if (!options.colours && options.cut_outs == nullptr) return;
  const MtlOptions mtl{options.budget, options.allow_outside, nullptr, options.colours,
                       options.cut_outs};
  for (const std::string& beside : mtl_files(content, mtl)) visit(File::open_read(beside));
}

void visit_gltf_files(const File& content, const BesideOptions& options, const VisitFile& visit) {
  const Tile tile(content, options.budget);
  if (tile.beside() != nullptr) visit(*tile.beside());
  const GltfDocument document =
      load_with_cut_outs(tile.gltf_file(), options.budget, {.images = options.colours},
                         tile.gltf_bytes(), options.cut_outs);
  for (const File& buffer : GltfBuffers(document, options.budget).files()) visit(buffer);
  for (const File& image : image_files(document)) visit(image);
}

#ifdef SVDAG_HAS_OPENMESH
constexpr auto kReadOpenMesh = read_openmesh;
#else
constexpr auto kReadOpenMesh = nullptr;
#endif
#ifdef SVDAG_HAS_ASSIMP
constexpr auto kReadCollada = read_collada;
constexpr auto kRead3ds = read_3ds;
#else
constexpr auto kReadCollada = nullptr, kRead3ds = nullptr;
#endif
#ifdef SVDAG_HAS_UFBX
constexpr auto kReadFbx = read_fbx;
#else
constexpr auto kReadFbx = nullptr;
#endif
#ifdef SVDAG_HAS_3MF
constexpr auto kRead3mf = read_3mf;
#else
constexpr auto kRead3mf = nullptr;
#endif

constexpr const char* kAsGlb = ": open it in Blender and export it as .glb";

constexpr SceneFormat kFormats[] = {
    {"PLY", "ply", true, begins_as_ply, "", read_ply, "", nullptr, is_point_cloud},
    {"STL", "stl", true, nullptr, "solid", read_stl},
    {"OBJ", "obj", true, nullptr, "", read_obj, "", visit_mtl_files},
    {"OFF", "off", true, nullptr, "OFF", read_off},
    {"glTF", "gltf", true, nullptr, "", read_gltf, "", visit_gltf_files, nullptr, gltf_animations},
    {"GLB", "glb", false, begins_as_glb, "", read_gltf, "", visit_gltf_files, nullptr,
     gltf_animations},
    {"B3DM", "b3dm", false, begins_as_b3dm, "", read_gltf, "", visit_gltf_files, nullptr,
     gltf_animations},
    {"I3DM", "i3dm", false, begins_as_i3dm, "", read_gltf, "", visit_gltf_files, nullptr,
     gltf_animations},
    {"Draco", "drc", false, begins_as_draco, "", read_draco},
    {"OpenMesh", "om", false, nullptr, "", kReadOpenMesh},
    {"FBX", "fbx", false, begins_as_fbx, "", kReadFbx, kAsGlb},
    {"COLLADA", "dae", false, nullptr, "", kReadCollada, kAsGlb},
    {"3MF", "3mf", false, nullptr, "", kRead3mf, kAsGlb},
    {"3DS", "3ds", false, nullptr, "", kRead3ds, kAsGlb},
};

constexpr const char* kByBlender = "open it in Blender and export it as .glb";
constexpr const char* kBySvdagUsd =
    "svdag-usd bakes it, a program of the Python package with the extra [usd]";
constexpr const char* kByMeshLab = "convert it to .ply, for example with MeshLab or Open3D";
constexpr const char* kByCloudCompare =
    "svdag bakes triangles: reconstruct a surface first, for example with CloudCompare";
constexpr const char* kByImport = "svdag import takes points; for triangles, reconstruct a surface";

struct ForeignFormat {
  std::string_view endings;  // separated by spaces, with one at both ends
  std::string_view start;    // the file's first bytes; empty: only the ending identifies it
  const char* name;
  const char* advice;
};

constexpr ForeignFormat kForeignFormats[] = {
    {" blend ", "BLENDER", "Blender", kByBlender},
    {" abc ", "Ogawa", "Alembic", kByBlender},
    {" usd usda usdz ", "#usda", "USD", kBySvdagUsd},
    {" usdc ", "PXR-USDC", "USD", kBySvdagUsd},
    {" step stp iges igs ", "ISO-1030", "a CAD model",
     "tessellate it, for example with FreeCAD, and export it as .stl"},
    {" vrml wrl x3d ", "#VRML", "VRML or X3D", kByMeshLab},
    {" las laz ", "LASF", "a point cloud (LAS)", kByImport},
    {" pcd xyz ", "", "a point cloud", kByImport},
    {" e57 pts ", "ASTM-E57", "a point cloud", kByCloudCompare},
    {" cmpt ", "cmpt\1", "a composite of 3D Tiles", "unpack its tiles"},
    {" pnts ", "pnts\1", "a point cloud of 3D Tiles", kByCloudCompare},
    {" splat spz ", "", "a Gaussian splat", "svdag bakes triangles: extract a mesh first"},
    {" zst ", "\x28\xb5\x2f\xfd", "compressed with zstd", "unpack it with unzstd"},
    {" zip ", "PK\x03\x04", "a ZIP archive", "unpack it and name the scene in it"},
    {" vdb ", " BDV", "an OpenVDB grid", "svdag import reads its voxels"},
    {" npz npy binvox vox ", "", "a voxel file", "svdag import reads its voxels"},
};

// "ply" for "folder/a.PLY" and "folder/a.ply.gz".
std::string lower_ending(const std::string& path) {
  std::string name = path.substr(path.find_last_of('/') + 1);
  for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  const size_t dot = name.find_last_of('.');
  return dot == std::string::npos ? "" : name.substr(dot + 1);
}

const SceneFormat* find_format(std::string_view ending, std::string_view start) {
  const auto first = [](const auto& matches) {
    const SceneFormat* found = std::find_if(std::begin(kFormats), std::end(kFormats), matches);
    return found == std::end(kFormats) ? nullptr : found;
  };
  const SceneFormat* format = first([&](const SceneFormat& each) {
    return each.begins != nullptr && each.begins(start, ending == "stl");
  });
  if (format == nullptr)
    format = first([&](const SceneFormat& each) { return each.ending == ending; });
  if (format == nullptr)
    format = first([&](const SceneFormat& each) {
      return !each.weak_start.empty() && start.starts_with(each.weak_start);
    });
  return format;
}

// A binary STL has no magic: its size follows from its count of triangles.
bool looks_like_stl(const File& file, std::string_view start) {
  if (start.starts_with("solid ") || start.starts_with("solid\n")) return true;
  uint32_t triangles = 0;
  constexpr uint64_t kHeader = 84, kTriangle = 50;
  if (file.size() < kHeader) return false;
  file.read_at(kHeader - sizeof triangles, std::as_writable_bytes(std::span(&triangles, 1)));
  return triangles > 0 && file.size() == kHeader + kTriangle * triangles;
}

// "PLY, STL and OBJ".
std::string format_names() {
  std::string names;
  for (const SceneFormat& each : kFormats) {
    if (&each != std::begin(kFormats)) names += &each + 1 == std::end(kFormats) ? " and " : ", ";
    names += each.name;
  }
  return names;
}

}  // namespace

const SceneFormat& detect_format(const File& file) {
  std::array<char, 8> head{};
  const auto bytes = std::as_writable_bytes(std::span(head));
  is_gzip(file) ? unpack_start(file, bytes) : file.read_some_at(0, bytes);
  std::string_view start(head.data(), head.size());
  if (start.starts_with(kByteOrderMark)) start.remove_prefix(kByteOrderMark.size());
  const std::string ending = lower_ending(file.path());
  if (const SceneFormat* format = find_format(ending, start)) {
    const bool by_name = format->ending == ending && ending != "stl" &&
                         (format->begins == nullptr || !format->begins(start, false));
    if (by_name && looks_like_stl(file, start))
      fail_input(file.path(), "is an STL under the name of another format: rename it to .stl");
    return *format;
  }
  if (ending == "svdag")
    fail_input(file.path(), "is a .svdag, not a scene: svdag info shows what it contains");
  const std::string foreign = foreign_format_message(ending, start);
  if (!foreign.empty()) fail_input(file.path(), foreign);
  fail_input(file.path(), "is not a supported scene file: svdag reads " + format_names() +
                              " files, also as .gz; OBJ and binary STL by the ending of their "
                              "names");
}

LeftOut read_scene_file(const SceneFormat& format, const File& file, const ReadOptions& options,
                        const TriangleSink& sink) {
  if (format.read == nullptr)
    fail_input(file.path(), std::string("is ") + format.name +
                                ", which this build of svdag cannot read" + format.alternative);
  return read_meshes(format.read, file, options, sink);
}

std::vector<std::string> scene_endings() {
  std::vector<std::string> endings;
  for (const SceneFormat& each : kFormats) endings.push_back("." + std::string(each.ending));
  for (const SceneFormat& each : kFormats) {
    if (each.usual_as_gz) endings.push_back("." + std::string(each.ending) + ".gz");
  }
  return endings;
}

std::string foreign_format_message(std::string_view ending, std::string_view start) {
  const std::string word = " " + std::string(ending) + " ";
  for (const ForeignFormat& each : kForeignFormats) {
    const bool by_name = !ending.empty() && each.endings.find(word) != std::string_view::npos;
    const size_t length = std::min(start.size(), each.start.size());
    const bool by_start = length >= 2 && each.start.substr(0, length) == start.substr(0, length);
    if (by_name || by_start)
      return std::string("is ") + each.name + ", which svdag does not read: " + each.advice;
  }
  return "";
}

}  // namespace svdag
