// Ray, point and box queries of a `.svdag` in a shader (Vulkan GLSL), on the bytes of the file.
//
//   #define SVDAG_SET 0      // descriptor set and binding of the storage buffers with the file
//   #define SVDAG_BINDING 0
//   #define SVDAG_BUFFERS 1  // their number, 1 to 16
//   #include "svdag/shaders/svdag.glsl"
//
//   SvdagHit hit;
//   if (svdag_trace(SvdagDag(0u, 0u, 0u), svdag_ray(origin, direction), 1e30, hit)) ...
//
// The file, plain or compact, is copied unchanged: its word i (u32) is word i & 0x1ffffff of buffer i >> 25. So buffers
// have at most 2^27 bytes, which every Vulkan device binds, and a file has at most 2 GiB. If a device binds more, one
// buffer with SVDAG_BUFFER_BITS 29 is faster. For other storage define SVDAG_WORD as the name of a function
// uint f(uint i), declared before. Several files, such as tiles, may follow each other; SvdagDag selects one.
//
// The file (docs/format.md): its grid has 2^L voxels on a side. A node of level k is a cube of side 2^(L-k); the root
// is level 0. A node is known by an index into the section of its level: plain, of its first word; compact, its number.
// A brick, of level L-2, is 64 bits, one per voxel of 4^3. Here its bytes are the nodes of level L-1.
//
// The traversal (Laine and Karras 2010, as verify/trace/kernel/traverse.h): the ray is mirrored so that its coordinates
// only increase. Its cell is one integer per axis; bit L-1-k of the three selects the child of the node of level k.
//
//   descend  by the bits, until a child is absent (an empty cube) or the voxel is reached (the hit)
//   advance  leave the empty cube by the first of its three far planes; the new cell is the ray's at this time
//   ascend   the highest bit that differs between the old and the new cell gives the level of the node that contains
//            both. `path` holds the nodes above the cell, so the descent resumes there; nothing is popped
//
// Precision without doubles: a float over a grid of 64K^3 is exact to 2^-8 voxel, which shows in pictures. So a ray has
// an anchor close to the cell: a time `begin`, at which its position is an integer `base` plus a `start` below 4. begin
// has 12 significant bits and a direction is divided into integers of 11, 9 and 18 bits, so that their products are
// exact in floats. The anchor is renewed every 64 voxels or so (in larger grids, at 1/1000 of the time), so that at
// 64K^3 positions err by about 2^-16 voxel. Only a ray that passes an edge so closely may hit the neighbouring voxel.
#ifndef SVDAG_GLSL
#define SVDAG_GLSL

struct SvdagDag {
  uint file;    // first word of the file
  uint root;    // 0, or the root of a layer: DagFile::root_node()
  uint tables;  // svdag_layer() and svdag_colour(): first word of their tables (examples/vulkan/gpu_tables.h)
};

// Coordinates are in voxels: voxel (0, 0, 0) is from 0 to 1. Convert from world coordinates in doubles
// (voxel_from_world()), before the shader.
struct SvdagRay {
  ivec3 cell;    // the origin, rounded down; at most 2^28 from 0
  vec3 inside;   // its fraction, 0 <= inside < 1
  ivec3 coarse;  // the direction in units of 2^-18, rounded down; the largest component is 2^17 to 2^20
  ivec3 fine;    // its remainder in units of 2^-36, 0 to 2^18 - 1
};

struct SvdagHit {
  ivec3 voxel;
  vec3 inside;  // where the ray enters the voxel, relative to its corner
  int axis;     // normal of the face through which it enters
  float t;      // when, in units of the length of the direction; 0 if the ray begins in the voxel
};

const uint SVDAG_NONE = 0xffffffffu;  // no child, layer or colour

#ifndef SVDAG_WORD
#define SVDAG_WORD svdag_word
#ifndef SVDAG_BUFFER_BITS
#define SVDAG_BUFFER_BITS 25
#endif
layout(set = SVDAG_SET, binding = SVDAG_BINDING)
readonly buffer SvdagWords { uint words[]; } svdag_buffers[SVDAG_BUFFERS];

// A switch, because a device may not be able to select a buffer by a number that differs between threads.
uint svdag_word(uint i) {
#define SVDAG_CASE(b) case b: return svdag_buffers[b < SVDAG_BUFFERS ? b : 0].words[i & (1u << SVDAG_BUFFER_BITS) - 1u];
#if SVDAG_BUFFERS > 1
  switch (int(i >> SVDAG_BUFFER_BITS)) {
    SVDAG_CASE(1) SVDAG_CASE(2) SVDAG_CASE(3)
#if SVDAG_BUFFERS > 4
    SVDAG_CASE(4) SVDAG_CASE(5) SVDAG_CASE(6) SVDAG_CASE(7) SVDAG_CASE(8) SVDAG_CASE(9)
    SVDAG_CASE(10) SVDAG_CASE(11) SVDAG_CASE(12) SVDAG_CASE(13) SVDAG_CASE(14) SVDAG_CASE(15)
#endif
  }
#endif
  return svdag_buffers[0].words[i & (1u << SVDAG_BUFFER_BITS) - 1u];
}
#endif

// Fields of the header, by the number of their word.
int svdag_levels(SvdagDag dag) { return int(SVDAG_WORD(dag.file + 4u)); }
bool svdag_is_plain(SvdagDag dag) { return SVDAG_WORD(dag.file + 192u) == 0u; }
uint svdag_section(SvdagDag dag, int level) { return dag.file + (SVDAG_WORD(dag.file + 44u + 6u * uint(level)) >> 2); }
uint svdag_node_count(SvdagDag dag, int level) { return SVDAG_WORD(dag.file + 48u + 6u * uint(level)); }
bool svdag_empty(SvdagDag dag, int levels) { return dag.root == SVDAG_NONE || svdag_node_count(dag, levels - 2) == 0u; }

// The number of the child of side 2^shift that holds a cell.
uint svdag_octant(ivec3 cell, int shift) {
  ivec3 bit = cell >> shift & 1;
  return uint(bit.x << 2 | bit.y << 1 | bit.z);
}

// `width` <= 32 bits, from bit `bit` after the word `at` on.
uint svdag_bits(uint at, uint bit, uint width) {
  uint i = at + (bit >> 5), shift = bit & 31u;
  uint bits = SVDAG_WORD(i) >> shift;
  if (shift + width > 32u) bits |= SVDAG_WORD(i + 1u) << 32u - shift;
  return bitfieldExtract(bits, 0, int(width));
}

// ---- Children -------------------------------------------------------------------------------------------------------

// Compact layout (io/dag/compact_view.h): a line has the children of 32 nodes, as 32 bytes m0 and 32 bytes m1. Bits c
// of a node's two bytes are the state of child c: 0 absent, else 1 + its class. Reference number t to a class, counted
// through the level, is in the class's stream; the base table has the counts before each line.
uint svdag_compact_child(uint entry, uint nodes, uint node, uint c) {
  uint line = entry + 16u + 16u * (node >> 5), word = node >> 2 & 7u, bit = 8u * (node & 3u) + c;
  uint m0 = SVDAG_WORD(line + word), m1 = SVDAG_WORD(line + 8u + word);
  uint state = (m0 >> bit & 1u) | (m1 >> bit & 1u) << 1, of_class = state - 1u;
  if (state == 0u) return SVDAG_NONE;

  // Counts the children of the class before this one.
  uint lines = nodes + 31u >> 5, bases = entry + 16u + 16u * lines;
  uint not0 = (state & 1u) - 1u, not1 = (state >> 1) - 1u;
  uint t = SVDAG_WORD(bases + 3u * (node >> 5) + of_class);
  t += uint(bitCount((m0 ^ not0) & (m1 ^ not1) & (1u << bit) - 1u));
  for (uint i = 0u; i < word; ++i)
    t += uint(bitCount((SVDAG_WORD(line + i) ^ not0) & (SVDAG_WORD(line + 8u + i) ^ not1)));

  bool is_private = SVDAG_WORD(entry) == 0u;  // class 0 has no stream: node t of it
  if (is_private && of_class == 0u) return t;
  uint first = 0u, stream = bases + (3u * lines + 15u & ~15u);
  for (uint s = 0u; s < of_class; ++s) {
    first += SVDAG_WORD(entry + 4u + s);
    if (is_private && s == 0u) continue;
    uint count = SVDAG_WORD(entry + 8u + 2u * s), width = SVDAG_WORD(entry + 1u + s);
    stream += (count >> 5) * width + (((count & 31u) * width + 7u >> 3) + 11u >> 2) + 15u & ~15u;
  }
  uint width = SVDAG_WORD(entry + 1u + of_class);
  return first + svdag_bits(stream + (t >> 5) * width, (t & 31u) * width, width);
}

// The child c of a node of a level below L, or SVDAG_NONE. A voxel, of level L, is 0.
uint svdag_child(SvdagDag dag, int levels, int level, uint node, uint c) {
  if (level == levels - 1) return (node >> c & 1u) != 0u ? 0u : SVDAG_NONE;
  uint section = svdag_section(dag, level);
  if (level == levels - 2) {
    uint voxels = SVDAG_WORD(section + 2u * node + (c >> 2)) >> 8u * (c & 3u) & 255u;
    return voxels != 0u ? voxels : SVDAG_NONE;
  }
  if (!svdag_is_plain(dag)) return svdag_compact_child(section, svdag_node_count(dag, level), node, c);
  uint mask = SVDAG_WORD(section + node);
  if ((mask >> c & 1u) == 0u) return SVDAG_NONE;
  return SVDAG_WORD(section + node + 1u + uint(bitCount(mask & (1u << c) - 1u)));
}

// ---- Rays -----------------------------------------------------------------------------------------------------------

// `direction` has length 1.
SvdagRay svdag_ray(ivec3 cell, vec3 inside, vec3 direction) {
  vec3 scaled = direction * 262144., coarse = floor(scaled);
  return SvdagRay(cell, inside, ivec3(coarse), ivec3((scaled - coarse) * 262144.));
}
SvdagRay svdag_ray(vec3 origin, vec3 direction) { return svdag_ray(ivec3(floor(origin)), fract(origin), direction); }

// A mirrored ray. At the time begin + t it is at base + start + t * slope.
struct SvdagWalk {
  uint flip;  // the mirrored axes, as a child number
  ivec3 cell, base, pieces[3];  // pieces: of the direction, in units of 2^-9, 2^-18 and 2^-36
  vec3 inside, start, slope, inverse;
  float begin;
};

SvdagWalk svdag_mirrored(SvdagRay ray, int size) {
  SvdagWalk walk;
  walk.flip = 0u;
  for (int a = 0; a < 3; ++a) {
    if (ray.coarse[a] >= 0) continue;
    walk.flip |= 4u >> uint(a);
    bool borrow = ray.fine[a] > 0;
    ray.fine[a] = borrow ? 0x40000 - ray.fine[a] : 0;
    ray.coarse[a] = -ray.coarse[a] - int(borrow);
    ray.cell[a] = size - ray.cell[a] - int(ray.inside[a] > 0.);
    ray.inside[a] = ray.inside[a] > 0. ? 1. - ray.inside[a] : 0.;
  }
  walk.cell = ray.cell;
  walk.inside = ray.inside;
  walk.pieces = ivec3[3](ray.coarse >> 9, ray.coarse & 511, ray.fine);
  walk.slope = max(vec3(ray.coarse) * 3.814697265625e-6 + vec3(ray.fine) * 1.4551915228366852e-11, 1e-12);
  walk.inverse = 1. / walk.slope;
  return walk;
}

// Sets the anchor to the time t, rounded down. The factors are 2^-9, 2^-18 and 2^-36.
void svdag_anchor(inout SvdagWalk walk, float t) {
  walk.begin = uintBitsToFloat(floatBitsToUint(t) & 0xfffff000u);
  vec3 a = vec3(walk.pieces[0]) * (walk.begin * 0.001953125);
  vec3 b = vec3(walk.pieces[1]) * (walk.begin * 3.814697265625e-6);
  vec3 c = vec3(walk.pieces[2]) * (walk.begin * 1.4551915228366852e-11);
  walk.base = walk.cell + ivec3(floor(a)) + ivec3(floor(b));
  walk.start = walk.inside + (a - floor(a)) + (b - floor(b)) + c;
}

// The times at which the planes x, y, z = plane are crossed, relative to begin; the cell at such a time.
vec3 svdag_times(SvdagWalk walk, ivec3 plane) { return (vec3(plane - walk.base) - walk.start) * walk.inverse; }
ivec3 svdag_cell(SvdagWalk walk, float t) { return walk.base + ivec3(floor(walk.start + walk.slope * t)); }

float svdag_max(vec3 v) { return max(v.x, max(v.y, v.z)); }
float svdag_min(vec3 v) { return min(v.x, min(v.y, v.z)); }

SvdagHit svdag_hit(SvdagWalk walk, ivec3 cell, int size) {
  vec3 t = svdag_times(walk, cell);
  int axis = t.x >= t.y && t.x >= t.z ? 0 : t.y >= t.z ? 1 : 2;
  float enter = max(t[axis], -walk.begin);
  vec3 inside = clamp(vec3(walk.base - cell) + walk.start + walk.slope * enter, 0., 1.);
  if (enter == t[axis]) inside[axis] = 0.;
  bvec3 flipped = notEqual(uvec3(walk.flip) & uvec3(4, 2, 1), uvec3(0));
  return SvdagHit(mix(cell, size - 1 - cell, flipped), mix(inside, 1. - inside, flipped), axis, walk.begin + enter);
}

// The first voxel that the ray meets before the time `end`; false if there is none. At least one coordinate of the cell
// increases with each step, so the loop ends.
bool svdag_trace(SvdagDag dag, SvdagRay ray, float end, out SvdagHit hit) {
  int levels = svdag_levels(dag), size = 1 << levels;
  SvdagWalk walk = svdag_mirrored(ray, size);
  svdag_anchor(walk, 0.);
  svdag_anchor(walk, max(svdag_max(svdag_times(walk, ivec3(0))), 0.));  // enters the grid
  float now = max(svdag_max(svdag_times(walk, ivec3(0))), -walk.begin);
  if (svdag_empty(dag, levels) || now >= svdag_min(svdag_times(walk, ivec3(size)))) return false;
  ivec3 cell = clamp(svdag_cell(walk, now), 0, size - 1);

  uint path[20];  // nodes of the levels 0 .. level
  path[0] = dag.root;
  int level = 0;
  while (walk.begin + now < end) {
    int shift = levels - 1 - level;
    for (;; --shift) {
      uint child = svdag_child(dag, levels, level, path[level], svdag_octant(cell, shift) ^ walk.flip);
      if (child == SVDAG_NONE) break;
      if (shift == 0) {
        hit = svdag_hit(walk, cell, size);
        return true;
      }
      path[++level] = child;
    }
    ivec3 far = (cell | (1 << shift) - 1) + 1;
    vec3 t = svdag_times(walk, far);
    now = svdag_min(t);
    if (now > 64. + walk.begin * 0.001) {
      svdag_anchor(walk, walk.begin + now);
      t = svdag_times(walk, far);
      now = svdag_min(t);
    }
    ivec3 next = mix(clamp(svdag_cell(walk, now), cell, far - 1), far, lessThanEqual(t, vec3(now)));
    if (any(greaterThanEqual(next, ivec3(size)))) return false;
    ivec3 changed = next ^ cell;
    cell = next;
    level = min(level, levels - 1 - findMSB(changed.x | changed.y | changed.z));
  }
  return false;
}

// ---- Points and boxes -----------------------------------------------------------------------------------------------

// 0 if the voxel, inside `node` of `level`, is set; else the side of the largest empty cube around it.
int svdag_empty_side(SvdagDag dag, int level, uint node, ivec3 voxel) {
  int levels = svdag_levels(dag);
  for (; level < levels; ++level) {
    node = svdag_child(dag, levels, level, node, svdag_octant(voxel, levels - 1 - level));
    if (node == SVDAG_NONE) return 1 << levels - 1 - level;
  }
  return 0;
}

// Whether a voxel is set.
bool svdag_point(SvdagDag dag, ivec3 voxel) {
  int levels = svdag_levels(dag);
  if (svdag_empty(dag, levels) || any(notEqual(voxel >> levels, ivec3(0)))) return false;
  return svdag_empty_side(dag, 0, dag.root, voxel) == 0;
}

// Whether a voxel of the box min <= v < max is set. Visits the cubes at the box's surface in the order of children, by
// the bits of the cube's corner, as a ray does; a cube inside has a voxel.
bool svdag_box(SvdagDag dag, ivec3 box_min, ivec3 box_max) {
  int levels = svdag_levels(dag), level = 0;
  if (svdag_empty(dag, levels)) return false;
  uint path[20];
  path[0] = dag.root;
  ivec3 corner = ivec3(0);  // of the child that is visited
  for (;;) {
    int shift = levels - 1 - level;
    ivec3 end = corner + (1 << shift);
    uint child = SVDAG_NONE;
    if (all(lessThan(corner, box_max)) && all(greaterThan(end, box_min)))
      child = svdag_child(dag, levels, level, path[level], svdag_octant(corner, shift));
    if (child != SVDAG_NONE) {
      if (all(greaterThanEqual(corner, box_min)) && all(lessThanEqual(end, box_max))) return true;
      path[++level] = child;
      continue;
    }
    for (; svdag_octant(corner, shift) == 7u; ++shift)
      if (level-- == 0) return false;
    int next = int(svdag_octant(corner, shift)) + 1;
    corner = (corner >> shift + 1 << shift + 1) | (ivec3(next) >> ivec3(2, 1, 0) & 1) << shift;
  }
}

// ---- Layers and colours ---------------------------------------------------------------------------------------------

// The first layer with the voxel, which must be in the grid; else SVDAG_NONE. As layer_of_cube() of
// io/dag/layers/layer_index.h: the table lists the layers in each cube of a coarse level, with their nodes.
uint svdag_layer(SvdagDag dag, ivec3 voxel) {
  uint table = dag.tables + SVDAG_WORD(dag.tables), cube = 0u;
  int levels = svdag_levels(dag), level = int(SVDAG_WORD(table));
  for (int k = 0; k < level; ++k) cube = cube << 3 | svdag_octant(voxel, levels - 1 - k);
  uint entries = table + 2u + (1u << 3 * level), end = SVDAG_WORD(table + 2u + cube);
  for (uint i = entries + 2u * SVDAG_WORD(table + 1u + cube); i < entries + 2u * end; i += 2u)
    if (svdag_empty_side(dag, level, SVDAG_WORD(i + 1u), voxel) == 0) return SVDAG_WORD(i);
  return SVDAG_NONE;
}

// Colour `rank` of a chunk (io/dag/colours/chunk_view.h): runs of colours, found by a search of the groups of 16 runs,
// then run by run. Channels of a line are between its two ends.
uint svdag_chunk_colour(uint chunk, uint rank) {
  uint runs = SVDAG_WORD(chunk), groups = runs + 15u >> 4, low = 0u;
  for (uint high = groups; high - low > 1u;) {
    uint middle = low + high >> 1;
    if ((SVDAG_WORD(chunk + 1u + middle) & 0x3fffu) <= rank) low = middle; else high = middle;
  }
  uint group = SVDAG_WORD(chunk + 1u + low), headers = chunk + 1u + groups, payload = headers + (runs * 11u + 31u >> 5);
  uint i = rank - (group & 0x3fffu), bit = group >> 14 << 1;
  for (uint header = 176u * low;; header += 11u) {
    uint run = svdag_bits(headers, header, 11u), kind = run >> 8, size = (run & 255u) + 1u << (kind == 1u ? 8 : 0);
    bool line = kind >= 2u && kind < 6u;
    uint width = line ? kind - 1u : kind == 6u ? 24u : 0u;
    if (i >= size) {
      i -= size;
      bit += (kind < 2u ? 24u : line ? 36u : 0u) + width * size;
      continue;
    }
    if (kind == 7u) return SVDAG_NONE;
    if (!line) return svdag_bits(payload, bit + width * i, 24u);
    uvec3 a = uvec3(svdag_bits(payload, bit, 18u)) >> uvec3(0, 6, 12) & 63u;
    uvec3 b = uvec3(svdag_bits(payload, bit + 18u, 18u)) >> uvec3(0, 6, 12) & 63u;
    uint weight = svdag_bits(payload, bit + 36u + width * i, width), last = (1u << width) - 1u;
    uvec3 channel = ((a << 2 | a >> 4) * (last - weight) + (b << 2 | b >> 4) * weight + last / 2u) / last;
    return channel.r | channel.g << 8 | channel.b << 16;
  }
}

uvec2 svdag_brick(SvdagDag dag, int levels, uint number) {
  uint at = svdag_section(dag, levels - 2) + 2u * number;
  return uvec2(SVDAG_WORD(at), SVDAG_WORD(at + 1u));
}

// The bytes of a brick that are not 0.
uint svdag_byte_mask(uvec2 brick) {
  uint mask = 0u;
  for (uint c = 0u; c < 8u; ++c) mask |= uint((brick[c >> 2] >> 8u * (c & 3u) & 255u) != 0u) << c;
  return mask;
}

// The number of colours in a node of level k, 1 .. K.
uint svdag_colour_count(SvdagDag dag, int levels, int k, uint node, int finest) {
  if (k == finest) return 1u;
  if (k < levels - 2)
    return SVDAG_WORD(dag.tables + SVDAG_WORD(dag.tables + uint(k)) + (svdag_is_plain(dag) ? node >> 1 : node));
  uvec2 brick = svdag_brick(dag, levels, node);
  return uint(finest < levels ? bitCount(svdag_byte_mask(brick)) : 1 + bitCount(brick.x) + bitCount(brick.y));
}

// The colour of a voxel of the grid: r | g << 8 | b << 16, sRGB; else SVDAG_NONE. As svdag_colour() of
// io/dag/colours/colour_view.h: colours are numbered depth first, and the table has the count of each node. The file
// must have fewer than 2^32 colours.
uint svdag_colour(SvdagDag dag, ivec3 voxel) {
  int levels = svdag_levels(dag), finest = int(SVDAG_WORD(dag.file + 216u));
  if (finest == 0 || svdag_empty(dag, levels)) return SVDAG_NONE;
  uint number = 0u, node = 0u;
  for (int k = 0; k < finest; ++k) {
    number += uint(finest - k & 1) ^ 1u;  // its own, a mean
    uint c = svdag_octant(voxel, levels - 1 - k);
    if (k == levels - 2) {
      uvec2 brick = svdag_brick(dag, levels, node);
      uint bit = finest == levels ? 8u * c + svdag_octant(voxel, 0) : c;
      if (finest < levels) brick = uvec2(svdag_byte_mask(brick), 0);
      if ((brick[bit >> 5] >> (bit & 31u) & 1u) == 0u) return SVDAG_NONE;
      number += uint(bitCount(brick[bit >> 5] & (1u << (bit & 31u)) - 1u)) + (bit > 31u ? uint(bitCount(brick.x)) : 0u);
      break;
    }
    uint parent = node;
    for (uint child = 0u; child <= c; ++child) {
      node = svdag_child(dag, levels, k, parent, child);
      if (child < c && node != SVDAG_NONE) number += svdag_colour_count(dag, levels, k + 1, node, finest);
    }
    if (node == SVDAG_NONE) return SVDAG_NONE;
  }
  uint entries = dag.file + (SVDAG_WORD(dag.file + 210u) >> 2), low = 0u;
  for (uint high = SVDAG_WORD(dag.file + 212u) >> 4; high - low > 1u;) {
    uint middle = low + high >> 1;
    if (SVDAG_WORD(entries + 4u * middle) <= number) low = middle; else high = middle;
  }
  uint entry = entries + 4u * low, value = SVDAG_WORD(entry + 2u);
  if (SVDAG_WORD(entry + 3u) == 0u) return value;
  return svdag_chunk_colour(dag.file + (SVDAG_WORD(dag.file + 206u) >> 2) + value, number - SVDAG_WORD(entry));
}
#endif
