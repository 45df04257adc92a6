// One part of a 3MF archive: its objects and build items, parsed from XML with expat.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/affine.h"
#include "io/colour.h"
#include "io/scene/mesh/left_out.h"
#include "io/scene/readers/painted_corner.h"

namespace svdag {

// A component of an object, or an item of the build.
struct ThreeMfReference {
  std::string part;  // "" is the part of the reference; else its name, without the first slash
  uint32_t object = 0;
  Affine to_parent;
  bool is_printable = true;
};

// The number of a resource, or 0 for none, and an index in it.
using ThreeMfProperty = std::pair<uint32_t, uint32_t>;

struct ThreeMfObject {
  std::string name;
  LeftOut left_out;
  std::vector<Point> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> property_of;        // of each triangle: an index of `properties`
  std::vector<ThreeMfProperty> properties;  // of first corners, in the order of their first use
  // Of each triangle, if painted: the indices of its other corners in the group of its property.
  std::vector<std::array<uint32_t, 2>> other_corners;
  std::vector<ThreeMfReference> components;
  bool is_open = false;  // an instance of it is being sent
};

struct ThreeMfMaterial {
  std::string name;
  std::optional<Colour> colour;
};

// A colorgroup, whose corners are colours, or a texture2dgroup, whose corners are coordinates.
struct ThreeMfPaint {
  uint32_t texture = 0;                // the number of its image; 0: none
  std::vector<PaintedCorner> corners;  // v upwards
};

struct ThreeMfImage {
  std::string part;
  NamedPaint use;  // without its number
};

struct ThreeMfModel {
  double unit_metres = 0.001;
  std::map<uint32_t, ThreeMfObject> objects;
  std::map<uint32_t, std::vector<ThreeMfMaterial>> materials;  // by the number of their group
  std::map<uint32_t, ThreeMfPaint> paints;                     // the same
  std::map<uint32_t, ThreeMfImage> images;                     // by their number
  std::vector<ThreeMfReference> items;
  LeftOut left_out;  // of the whole part
};

// Passes the bytes of an XML file to its argument, the last time with is_last.
using XmlSource =
    std::function<void(const std::function<void(std::string_view piece, bool is_last)>&)>;

// `where`: the archive and the part, for errors. Damaged XML, a triangle with a vertex that does
// not exist and the like are an Error (kBadInput).
// `painted`: with the colours of points.
ThreeMfModel parse_three_mf_model(const XmlSource& source, const std::string& where,
                                  bool painted = false);

// The name of the part that holds the model, from the archive's relationships; "" if they name
// none.
std::string parse_three_mf_relationships(const XmlSource& source, const std::string& where);

}  // namespace svdag
