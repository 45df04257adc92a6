// The structures of the `.svdag` file format (docs/format.md).
//
//   header (1024 bytes) | level sections | layer table | colours | metadata (JSON) |
//   checksum table | end
//
// All parts are 64-byte aligned. In the plain layout the sections are ordered deepest first, in the
// compact layout root first. Files with colours have version 3; of the others, the plain layout
// without layers has version 1, all else version 2.
//
// Little-endian. No dependencies: host and CUDA code include this file through dag_view.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace svdag {

constexpr unsigned char kMagic[8] = {0x89, 'S', 'V', 'D', 'A', 'G', '\r', '\n'};
constexpr uint32_t kMaxSections = 19;  // levels 0 .. L-2, L <= 20
constexpr uint64_t kSectionAlignment = 64;
constexpr uint64_t kChecksumBlock = 65536;   // bytes covered by one entry of the checksum table
constexpr uint64_t kMaxWords = 0xfffffffeU;  // per section: the last two u32 values are reserved

enum class Layout : uint32_t { kPlain = 0, kCompact = 1 };

constexpr const char* kLayoutNames[] = {"plain", "compact"};

constexpr const char* layout_name(Layout layout) {
  return kLayoutNames[size_t(layout)];
}

// What a layer is in the scene.
enum class LayerKind : uint32_t { kNone, kObject, kMaterial, kFile, kFrame };

constexpr const char* kLayerKindNames[] = {"none", "object", "material", "file", "frame"};
constexpr uint32_t kMaxLayers = 65535;

constexpr const char* layer_kind_name(LayerKind kind) {
  return kLayerKindNames[size_t(kind)];
}

constexpr uint32_t kMaxVersion = 3;

constexpr uint32_t version_of(Layout layout, LayerKind layers, bool has_colours = false) {
  if (has_colours) return 3;
  return layout == Layout::kPlain && layers == LayerKind::kNone ? 1 : 2;
}

// Which voxels are set (docs/accuracy.md). The two solid rules differ in what is inside: points
// whose winding number is not zero, or is odd. kPoints: a half-open voxel is set if it holds a
// point of a cloud; all other rules are of triangles.
enum class Rule : uint32_t { kConservative = 0, kThin = 1, kSolid = 2, kSolidOdd = 3, kPoints = 4 };

constexpr const char* kRuleNames[] = {"conservative", "thin", "solid", "solid-odd", "points"};

constexpr const char* rule_name(Rule rule) {
  return kRuleNames[size_t(rule)];
}
constexpr bool is_solid(Rule rule) {
  return rule == Rule::kSolid || rule == Rule::kSolidOdd;
}
// Whether a solid rule sets the untouched voxels of this winding number.
constexpr bool is_inside(Rule rule, int32_t winding) {
  return rule == Rule::kSolid ? winding != 0 : rule == Rule::kSolidOdd && (winding & 1) != 0;
}

// One level. Inner levels (0 .. L-3): u32 words, or CompactEntry and what follows it; the brick
// level (L-2): u64 bricks.
struct Section {
  uint64_t offset;  // from the start of the file
  uint64_t bytes;   // without padding
  uint64_t nodes;   // nodes, or bricks
};

struct Header {
  unsigned char magic[8];
  uint32_t version;
  uint32_t header_bytes;  // 1024
  uint32_t levels;        // L
  uint32_t fraction;      // F
  uint32_t rule;          // Rule
  uint32_t grid_kind;     // Grid::Kind
  double corner[3];       // world position of the corner of voxel (0, 0, 0)
  double voxel_size;
  int64_t k0[3];           // plane number of the corner; kBox: 0
  uint32_t bounded;        // 1: voxels outside the selection are empty (--bounds, --cube)
  uint32_t section_count;  // L-1
  uint32_t selection_min[3];
  uint32_t selection_max[3];  // exclusive
  uint64_t voxels;            // set voxels
  double largest_snap;        // largest move of a coordinate by the snap, in voxels
  uint64_t metadata_offset, metadata_bytes;
  uint64_t checksum_offset, checksum_bytes;
  uint64_t file_bytes;
  Section sections[kMaxSections];  // [k] is level k; unused sections are zero
  uint64_t content_hash[2];  // XXH3-128 over the header (hash and checksum as 0) and the table,
                             // of the plain layout without colours
  double transform[12];      // of the scene into the world, 3x4, row by row; zeros: the identity
  double origin[3];          // kOrigin: world position of plane 0; else 0
  uint32_t layout;           // Layout
  uint32_t padding;          // zero
  uint64_t table_hash[2];    // compact or with colours: XXH3-128 of the checksum table; else zero
  // The layers; zeros in a file without.
  uint64_t layers_offset, layers_bytes;
  uint32_t layer_count;
  uint32_t layer_kind;  // LayerKind
  uint32_t has_union;   // 1: the first root is the union of all layers
  uint32_t padding2;    // zero
  // The colours; zeros in a file without.
  uint64_t chunks_offset, chunks_bytes;
  uint64_t directory_offset, directory_bytes;  // ColourEntry each
  uint64_t colour_count;
  uint32_t colour_level;        // K, 1 .. L: of the finest cubes with a colour
  uint32_t colour_error;        // the largest, in units of 1/256 step of 8 bits of sRGB
  uint64_t colour_hash[2];      // XXH3-128 of the three numbers before, the chunks, the directory
  unsigned char reserved[128];  // zero
  uint64_t header_checksum;     // XXH3-64 of the 1016 bytes before
};

// Whether the number of nodes of level 0 is possible: 0 in an empty file, else up to one per set.
constexpr bool has_possible_roots(const Header& h) {
  const uint64_t roots = h.sections[0].nodes;
  if (h.sections[h.levels - 2].nodes == 0) return roots == 0;
  return roots >= 1 && roots <= uint64_t(h.layer_count) + (h.layer_kind == 0 || h.has_union);
}

static_assert(sizeof(Section) == 24);
static_assert(offsetof(Header, corner) == 32);
static_assert(offsetof(Header, voxels) == 120);
static_assert(offsetof(Header, sections) == 176);
static_assert(offsetof(Header, content_hash) == 632);
static_assert(offsetof(Header, transform) == 648);
static_assert(offsetof(Header, layout) == 768);
static_assert(offsetof(Header, layers_offset) == 792);
static_assert(offsetof(Header, chunks_offset) == 824);
static_assert(offsetof(Header, colour_hash) == 872);
static_assert(offsetof(Header, header_checksum) == 1016);
static_assert(sizeof(Header) == 1024);

constexpr bool has_colours(const Header& h) {
  return h.colour_level != 0;
}
inline void clear_colours(Header* h) {
  h->chunks_offset = h->chunks_bytes = h->directory_offset = h->directory_bytes = 0;
  h->colour_count = h->colour_hash[0] = h->colour_hash[1] = 0;
  h->colour_level = h->colour_error = 0;
}
// Whether table_hash covers the checksum table; else content_hash does.
constexpr bool has_table_hash(const Header& h) {
  return Layout(h.layout) == Layout::kCompact || has_colours(h);
}

constexpr uint32_t kColourErrorUnit = 256;  // of Header::colour_error: a step
constexpr uint32_t kMaxColourError = 255 * kColourErrorUnit;

// The colours from number `first` up to the next entry's: a chunk (io/dag/colours/chunk_view.h), or
// one colour for all.
struct ColourEntry {
  uint64_t first;
  uint64_t value;  // kChunkEntry | number of its first word among the chunks; else the colour
};

constexpr uint64_t kChunkEntry = uint64_t(1) << 63;

static_assert(sizeof(ColourEntry) == 16);

// An entry of the layer table; the names follow the last one.
struct StoredLayer {
  uint64_t voxels;
  uint32_t root;  // number of the node in level 0; 0xffffffff without voxels
  uint32_t name_bytes;
  uint8_t colour[3];  // sRGB
  uint8_t reserved[5];
};

static_assert(sizeof(StoredLayer) == 24);

// Compact layout: how the nodes of an inner level refer to those of the level below, which are
// divided into the classes A, B and C (io/dag/compact_view.h). The section of a level consists of
// the entry, the lines of its nodes, the base table, and the streams of references A, B, C, each
// padded to 64 bytes.
enum class CompactKind : uint32_t {
  kPrivate = 0,  // A: nodes with one reference, in the order of their parents; not stored
  kExplicit = 1,
};

constexpr uint32_t kClasses = 3;
constexpr uint32_t kLineNodes = 32;      // nodes of a line
constexpr uint64_t kStreamReadable = 8;  // bytes that may be read after the last reference

struct CompactEntry {
  uint32_t kind;              // CompactKind
  uint32_t widths[kClasses];  // bits of a reference, 0 .. 32; 0 for a class without a stream
  uint32_t sizes[kClasses];   // nodes of the level below, by class
  uint32_t padding;           // zero
  uint64_t references[kClasses];
  uint64_t reserved;  // zero
};

static_assert(sizeof(CompactEntry) == 64);

}  // namespace svdag
