// The materials of an OBJ file, from the .mtl files that it names.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/colour.h"
#include "io/scene/colours/linear_images.h"
#include "io/scene/cutouts/cut_out.h"
#include "io/scene/mesh/left_out.h"
#include "io/scene/mesh/name_filter.h"
#include "streaming/file/file.h"

namespace svdag {

// A coordinate is scaled, then moved, as three.js and Blender do; v points up, from the last row of
// the image.
struct MtlTexture {
  std::string path;
  bool is_outside = false;                       // of the folder of the .obj file, and not allowed
  double scale[2] = {1, 1}, offset[2] = {0, 0};  // -s, -o
  bool clamp = false;                            // -clamp on
  std::string unknown;  // an option that changes the texels, but is not followed; empty: none

  // In texels of an image of this size; u, v: of vt.
  TexturePoint place(double u, double v, int64_t width, int64_t height) const {
    return {(u * scale[0] + offset[0]) * double(width),
            (1 - (v * scale[1] + offset[1])) * double(height)};
  }
  Wrap wrap() const { return clamp ? Wrap::kClamp : Wrap::kRepeat; }
};

struct MtlMaterial {
  std::optional<Colour> diffuse;              // Kd, which is sRGB
  double dissolve = 1;                        // d
  std::unique_ptr<MtlTexture> texture, mask;  // map_Kd, map_d; null: none
};

struct MtlMaterials {
  std::map<std::string, MtlMaterial, std::less<>> by_name;
  std::vector<std::string> files;    // paths of the .mtl files
  MemoryBudget::Reservation memory;  // for them
};

struct MtlOptions {
  MemoryBudget* budget = nullptr;
  bool allow_outside = false;  // also .mtl files and textures outside the folder of the .obj file
  LinearImages* images = nullptr;  // if given, it notes what was left out
  // Of mtl_files(): the textures that colour, and those that cut materials out, unless null.
  bool colours = true;
  const NameFilter* cut_outs = nullptr;
};

// The .mtl files are those named by `mtllib` in the first 64 KiB of `obj`, beside it, as far as
// they exist. What cannot be read in them is as if it were missing.
MtlMaterials read_mtl(const File& obj, const MtlOptions& options);

// What is left out of a line `mtllib NAME`: a file that exists, but is none of them, or one that
// does not exist; nothing if all are read.
std::optional<Omission> unread_mtl(const File& obj, std::string_view name,
                                   const MtlMaterials& materials);

// What cuts a material out: its map_d, or, if `names` has the name, its map_Kd; null: nothing.
const MtlTexture* cutting_texture(const std::string& name, const MtlMaterial& material,
                                  const NameFilter& names);

// Paths of these .mtl files and of the textures that they name, as far as they exist.
std::vector<std::string> mtl_files(const File& obj, const MtlOptions& options);

// Kd times the mean of map_Kd; nothing if the material has neither, or no texture that can be read
// and no Kd.
std::optional<Colour> colour_of(const MtlMaterial& material, LinearImages* images);

}  // namespace svdag
