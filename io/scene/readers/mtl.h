// The materials of an OBJ file, from the .mtl files that it names.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/colour.h"
#include "io/scene/decoders/image.h"
#include "streaming/file/file.h"

namespace svdag {

struct MtlMaterial {
  std::optional<Colour> diffuse;  // Kd, which is sRGB
  std::string texture;            // path of map_Kd; empty: none
};

struct MtlMaterials {
  std::map<std::string, MtlMaterial, std::less<>> by_name;
  MemoryBudget::Reservation memory;  // for them
};

struct MtlOptions {
  MemoryBudget* budget = nullptr;
  bool allow_outside = false;    // also .mtl files and textures outside the folder of the .obj file
  ImageMeans* images = nullptr;  // if given, it notes what was left out
};

// The .mtl files are those named by `mtllib` in the first 64 KiB of `obj`, beside it, as far as
// they exist. What cannot be read in them is as if it were missing.
MtlMaterials read_mtl(const File& obj, const MtlOptions& options);

// Paths of these .mtl files and of the textures that they name, as far as they exist.
std::vector<std::string> mtl_files(const File& obj, const MtlOptions& options);

// Kd times the mean of map_Kd; nothing if the material has neither, or no texture that can be read
// and no Kd.
std::optional<Colour> colour_of(const MtlMaterial& material, ImageMeans* images);

}  // namespace svdag
