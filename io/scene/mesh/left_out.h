// What a reader left out of a scene, or took otherwise than a viewer shows it: counts by kind.
// Every reader returns one, so that nothing is left out silently. The summary of a command prints a
// line for each kind, a report has its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace svdag {

enum class Omission : uint8_t {
  kPointsOrLines,
  kHidden,
  kCutOuts,
  kBlended,
  kVertexAlpha,
  kMaterialFiles,
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
  const char* name;  // in reports
  const char* text;  // after the count
};

// [Omission]
constexpr OmissionKind kOmissions[] = {
    {"points_or_lines", "groups of points or lines have no triangles"},
    {"hidden", "hidden nodes are not baked; --hidden bakes them"},
    {"cut_outs", "meshes of materials with transparent points are baked whole"},
    {"blended", "meshes of materials that blend are baked whole; --cutout PATTERN cuts them out"},
    {"vertex_alpha", "cut-out meshes have alpha of vertices, which is not followed"},
    {"material_files",
     "lines name .mtl files outside the scene's folder (--allow-outside reads them) or after 64 "
     "KiB"},
    {"vertex_colours", "meshes have colours of vertices, which are not read"},
    {"bright_colours", "vertices or faces have a colour beyond 1, which is read as 1"},
    {"colour_indices", "faces have an index of a colour map, which is not followed"},
    {"texture_points",
     "triangles have the colour of their material alone: a texture coordinate is NaN, infinite or "
     "beyond 2^40 texels"},
    {"unweighted", "skinned vertices without weights are placed by their node"},
    {"channels", "channels of animations are not followed: they move no node"},
    {"corners_left", "corners after the last whole triangle of a mesh are left out"},
    {"free_form", "free-form curves or surfaces are not baked"},
    {"header_lines", "unknown header lines are skipped"},
    {"bytes_after", "bytes after the last triangle are ignored"},
    {"no_end", "solids end without \"endsolid\": the file may be truncated"},
    {"not_printable", "items of the build are not to be printed and are not baked"},
    {"beams", "beams of beam lattices are not baked"},
    {"slices", "objects have slices, which are not baked"},
    {"unread", "parts are of a kind that svdag does not read"},
};
constexpr size_t kOmissionCount = std::size(kOmissions);

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
