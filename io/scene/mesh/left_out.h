// What a reader left out of a scene, or took otherwise than a viewer shows it: counts by kind.
// Every reader returns one, so that nothing is left out silently. The summary of a command prints a
// line for each kind, a report has its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>

#include "io/units.h"

namespace svdag {

enum class Omission : uint8_t {
  kPointsOrLines,
  kHidden,
  kCutOuts,
  kBlended,
  kVertexAlpha,
  kMaterialFiles,
  kMissingMaterials,
  kVertexColours,
  kBrightColours,
  kColourIndices,
  kTexturePoints,
  kUnweighted,
  kChannels,
  kCornersLeft,
  kFreeForm,
  kHeaderLines,
  kBytesAfter,
  kNoEnd,
  kNotPrintable,
  kBeams,
  kSlices,
  kUnread,
};

struct OmissionKind {
  const char* name;        // in reports
  const char *one, *many;  // after a count: "1 object has", "2 objects have"
  const char* text;        // after both
};

// [Omission]
constexpr OmissionKind kOmissions[] = {
    {"points_or_lines", "group of points or lines has", "groups of points or lines have",
     " no triangles"},
    {"hidden", "hidden node is", "hidden nodes are", " not baked; --hidden bakes hidden nodes"},
    {"cut_outs", "mesh of a material with transparent points is",
     "meshes of materials with transparent points are", " baked whole"},
    {"blended", "mesh of a material that blends is", "meshes of materials that blend are",
     " baked whole; --cutout PATTERN cuts out what is transparent"},
    {"vertex_alpha", "cut-out mesh has", "cut-out meshes have",
     " alpha of vertices, which is not followed"},
    {"material_files", "line names", "lines name",
     " .mtl files outside the scene's folder (--allow-outside reads them) or after 64 KiB"},
    {"missing_materials", "line names", "lines name", " .mtl files that do not exist"},
    {"vertex_colours", "mesh has", "meshes have", " colours of vertices, which are not read"},
    {"bright_colours", "vertex or face has", "vertices or faces have",
     " a colour beyond 1, which is read as 1"},
    {"colour_indices", "face has", "faces have",
     " an index of a colour map, which is not followed"},
    {"texture_points", "triangle has", "triangles have",
     " the colour of the material alone: a texture coordinate is NaN, infinite or beyond 2^40 "
     "texels"},
    {"unweighted", "skinned vertex without weights is", "skinned vertices without weights are",
     " placed by the node"},
    {"channels", "channel of animations is", "channels of animations are",
     " not followed: no node to move"},
    {"corners_left", "corner after the last whole triangle of a mesh is",
     "corners after the last whole triangle of a mesh are", " left out"},
    {"free_form", "free-form curve or surface is", "free-form curves or surfaces are",
     " not baked"},
    {"header_lines", "unknown header line is", "unknown header lines are", " skipped"},
    {"bytes_after", "byte after the last triangle is", "bytes after the last triangle are",
     " ignored"},
    {"no_end", "solid ends", "solids end", " without \"endsolid\": the file may be truncated"},
    {"not_printable", "item of the build is", "items of the build are",
     " not to be printed and not baked"},
    {"beams", "beam of beam lattices is", "beams of beam lattices are", " not baked"},
    {"slices", "object has", "objects have", " slices, which are not baked"},
    {"unread", "part is", "parts are", " of a kind that svdag does not read"},
};
constexpr size_t kOmissionCount = std::size(kOmissions);

// "2 objects have slices, which are not baked"
inline std::string omission_text(size_t kind, uint64_t count) {
  const OmissionKind& k = kOmissions[kind];
  return format_count(count) + " " + (count == 1 ? k.one : k.many) + k.text;
}

class LeftOut {
 public:
  void add(Omission kind, uint64_t count = 1) { counts_[size_t(kind)] += count; }
  LeftOut& operator+=(const LeftOut& other) {
    for (size_t i = 0; i < kOmissionCount; ++i) counts_[i] += other.counts_[i];
    return *this;
  }
  uint64_t operator[](size_t kind) const { return counts_[kind]; }
  // Calls visit(name, count) for each kind, in a fixed order.
  template <class AnyLeftOut, class Visit>
  friend void visit_left_out(AnyLeftOut& left_out, const Visit& visit) {
    for (size_t i = 0; i < kOmissionCount; ++i) visit(kOmissions[i].name, left_out.counts_[i]);
  }

 private:
  std::array<uint64_t, kOmissionCount> counts_{};
};

}  // namespace svdag
