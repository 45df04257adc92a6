// Draws the tiles: one pass traces a ray per pixel, the next one shades what they hit.
//
// The traversal of verify/trace/kernel/traverse.h: the cell is one integer coordinate per
// axis, whose bits are the path down from the root; the ray is mirrored so that coordinates only
// increase; a step leaves the largest empty cube, and resumes at the common ancestor.
//
// Exactness without doubles: cells are integers, and a ray's position is given relative to a cube
// nearby, in floats. Where the ray enters a tile, at the time t, the position there is computed
// anew from the eye and the direction:
//
//   direction  integers of 20 and 18 bits per component, affine in the pixel: 36 bits after the point
//   t          rounded down to 12 bits, so that the products with the pieces of a direction, of at
//              most 12 bits, are exact in a float and divide into integers and fractions
//
// So a position errs by 2^-15 of a tile's cell, at 1K^3 as at 64K^3. Rejected: one float over the
// grid (2^-8 voxel at 64K^3); sums of two floats (compilers may reorder them).

const VERTEX = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }`;

const RAYS = `#version 300 es
precision highp float;
precision highp int;
uniform int levels;  // the grid has 2^levels voxels on a side
uniform int height;  // of the picture
uniform ivec3 eyeCell;
uniform vec3 eyeFraction;
uniform ivec3 high[3], low[3];  // the directions: first, right, down, in units of 2^-18 and 2^-36

ivec2 pixel() { return ivec2(gl_FragCoord.x, float(height) - gl_FragCoord.y); }

void direction(ivec2 at, out ivec3 coarse, out ivec3 fine) {
  fine = low[0] + at.x * low[1] + at.y * low[2];
  coarse = high[0] + at.x * high[1] + at.y * high[2] + (fine >> 18);
  fine &= 0x3ffff;
}
vec3 float_direction(ivec2 at) {
  ivec3 coarse, fine;
  direction(at, coarse, fine);
  return vec3(coarse) * exp2(-18.) + vec3(fine) * exp2(-36.);
}`;

const TRACE = RAYS + `
precision highp usampler2DArray;
precision highp usampler2D;
uniform usampler2DArray pool;
uniform uint top;              // pointer to the root
uniform ivec3 clipMin, clipMax;  // only voxels in this box are shown
uniform usampler2D sets;       // [set]: its first layer that is shown, or HIDDEN
uniform bool someHidden;
layout(location = 0) out uvec4 hit;

const uint BRICK = 0x80000000u, ENTRY = 0x40000000u, SET = 0x80000000u, HIDDEN = 0xffffffffu, NOTHING = 0xffffffffu;
const int MAX_STEPS = 4095;
const bool HAS_COLOURS = OF_SCENE;  // else the compiler drops what is about them

uint word(uint at) {
  return texelFetch(pool, ivec3(at & 1023u, at >> 10u & 2047u, at >> 21u & 255u), 0).r;
}
uint popcount8(uint v) {
  v -= v >> 1u & 0x55u;
  v = (v & 0x33u) + (v >> 2u & 0x33u);
  return v + (v >> 4u) & 15u;
}
uint popcount32(uint v) {
  v -= v >> 1u & 0x55555555u;
  v = (v & 0x33333333u) + (v >> 2u & 0x33333333u);
  return ((v + (v >> 4u) & 0x0f0f0f0fu) * 0x01010101u) >> 24u;
}
// The mask of the bytes that are not 0.
uint bytes_set(uint v) {
  return uint((v & 0xffu) != 0u) | uint((v & 0xff00u) != 0u) << 1u | uint((v & 0xff0000u) != 0u) << 2u |
         uint(v >> 24u != 0u) << 3u;
}
// Of v < 2^24, not 0.
int highest_bit(int v) { return (floatBitsToInt(float(v)) >> 23) - 127; }
float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float smallest(vec3 v) { return min(v.x, min(v.y, v.z)); }
uint octant(ivec3 cell, int shift) {
  ivec3 bit = cell >> shift & 1;
  return uint(bit.x << 2 | bit.y << 1 | bit.z);
}

ivec3 cell;    // the current one, mirrored
uint flip;     // the axes that are
uint colours;  // of the tile (tiles.js), or NOTHING
// The ray, mirrored. At the time begin + t it is at base + start + t * slope.
ivec3 eye, pieces[3];
vec3 fraction, slope, inverse_slope;
ivec3 base;
vec3 start;
float begin;

void place(ivec3 corner, float t) {
  begin = uintBitsToFloat(floatBitsToUint(t) & 0xfffff000u);
  vec3 a = vec3(pieces[0]) * (begin * exp2(-9.)), b = vec3(pieces[1]) * (begin * exp2(-18.));
  vec3 c = vec3(pieces[2]) * (begin * exp2(-36.));
  base = corner;
  start = vec3(eye - corner + ivec3(floor(a)) + ivec3(floor(b))) + (fraction + (a - floor(a)) + (b - floor(b)) + c);
}
vec3 times(ivec3 plane) { return (vec3(plane - base) - start) * inverse_slope; }

// The number of cubes with colours, below levels below a node.
uint colours_in(uint node, int below) {
  if (below == 0) return 1u;
  if ((node & BRICK) == 0u) return word(node) >> 8u;
  uint low = word(node - BRICK), high = word(node - BRICK + 1u);
  return below == 2 ? popcount32(low) + popcount32(high) : popcount8(bytes_set(low) | bytes_set(high) << 4u);
}
// The colour of the cube around a cell that is set (tiles.js).
uint colour_of() {
  uint node = word(colours), at = word(colours + 1u);
  int end = int(word(colours + 3u));
  for (int k = int(word(colours + 2u)); k < end; ++k) {
    uint c = octant(cell, levels - 1 - k) ^ flip;
    if ((node & BRICK) != 0u) {
      uint low = word(node - BRICK), high = word(node - BRICK + 1u);
      if (end - k == 1) return word(at + popcount8((bytes_set(low) | bytes_set(high) << 4u) & (1u << c) - 1u));
      uint bit = (c & 3u) << 3u | (octant(cell, levels - 2 - k) ^ flip), before = (1u << bit) - 1u;
      return word(at + (c < 4u ? popcount32(low & before) : popcount32(low) + popcount32(high & before)));
    }
    uint child = node + 1u;
    for (uint left = word(node) & (1u << c) - 1u; left != 0u; left &= left - 1u)
      at += colours_in(word(child++), end - k - 1);
    node = word(child);
  }
  return word(at);
}
void traverse() {
  hit = uvec4(0);
  int size = 1 << levels;
  ivec3 coarse, fine;
  direction(pixel(), coarse, fine);
  flip = 0u;
  ivec3 cell_min = clipMin, cell_max = clipMax;
  for (int a = 0; a < 3; ++a) {
    eye[a] = eyeCell[a];
    fraction[a] = eyeFraction[a];
    if (coarse[a] < 0) {
      bool borrow = fine[a] > 0;
      fine[a] = borrow ? 0x40000 - fine[a] : 0;
      coarse[a] = borrow ? -coarse[a] - 1 : -coarse[a];
      eye[a] = size - 1 - eye[a];
      fraction[a] = 1. - fraction[a];
      cell_min[a] = size - clipMax[a];
      cell_max[a] = size - clipMin[a];
      flip |= 4u >> uint(a);
    }
  }
  pieces[0] = coarse >> 9;
  pieces[1] = coarse & 511;
  pieces[2] = fine;
  slope = max(vec3(coarse) * exp2(-18.) + vec3(fine) * exp2(-36.), 1e-12);
  inverse_slope = 1. / slope;

  place(cell_min, 0.);
  float enter = max(largest(times(cell_min)), 0.);
  if (enter >= smallest(times(cell_max))) return;
  place(cell_min, enter);
  enter = max(largest(times(cell_min)), -begin);
  cell = clamp(base + ivec3(floor(start + slope * enter)), cell_min, cell_max - 1);
  float now = enter;

  uint path[21];
  path[0] = top;
  int level = 0, entry_level = 0;
  uint layers = SET;
  colours = NOTHING;
  for (int steps = 0; steps < MAX_STEPS; ++steps) {
    int shift;  // of the cube to leave
    uint node = path[level];
    for (;;) {
      if ((node & (BRICK | ENTRY)) == ENTRY) {
        // A tile. The cell is on its faces or inside.
        uint at = node - ENTRY;
        node = word(at);
        layers = word(at + 1u);
        if (HAS_COLOURS) colours = word(at + 2u);
        path[level] = node;
        entry_level = level;
        ivec3 corner = cell & -1 << (levels - level);
        ivec3 low_corner = max(corner, cell_min), high_corner = min(corner + (1 << (levels - level)), cell_max);
        place(corner, max(begin + now, 0.));
        now = max(largest(times(low_corner)), -begin);
        cell = clamp(base + ivec3(floor(start + slope * now)), low_corner, high_corner - 1);
      }
      shift = levels - 1 - level;
      uint c = octant(cell, shift) ^ flip;
      if ((node & BRICK) != 0u) {
        uint at = node - BRICK;
        uint block = word(at + (c >> 2u)) >> ((c & 3u) << 3u) & 255u;
        if (block == 0u) break;
        --shift;
        uint voxel = octant(cell, shift) ^ flip;
        if ((block >> voxel & 1u) == 0u) break;
        uint value = layers;
        for (int k = entry_level; (value & SET) == 0u; ++k)
          value = word(value + (octant(cell, levels - 1 - k) ^ flip));
        uint set = value & ~SET;
        if (someHidden && texelFetch(sets, ivec2(set & 1023u, set >> 10u), 0).r == HIDDEN) break;
        ivec3 near = cell & -1 << shift;
        vec3 t = times(near);
        uint axis = t.x >= t.y && t.x >= t.z ? 0u : t.y >= t.z ? 1u : 2u;
        for (int a = 0; a < 3; ++a) {
          if ((flip & 4u >> uint(a)) != 0u) near[a] = size - (1 << shift) - near[a];
        }
        hit = uvec4(near.x, near.y, near.z, uint(levels - shift) | axis << 5u);
        hit.x |= uint(steps) << 20u;
        hit.y |= (set & 4095u) << 20u;
        hit.z |= set >> 12u << 20u;
        return;
      }
      uint mask = word(node);
      if ((mask >> c & 1u) == 0u) break;
      node = word(node + 1u + popcount8(mask & (1u << c) - 1u));
      path[++level] = node;
    }
    ivec3 far = (cell | (1 << shift) - 1) + 1;
    vec3 t = times(far);
    now = smallest(t);
    ivec3 next = clamp(base + ivec3(floor(start + slope * now)), cell, far - 1);
    for (int a = 0; a < 3; ++a) next[a] = t[a] <= now ? far[a] : next[a];
    if (any(greaterThanEqual(next, cell_max))) return;
    ivec3 changed = next ^ cell;
    cell = next;
    level = min(level, levels - 1 - highest_bit(changed.x | changed.y | changed.z));
  }
}

// The look-up is not in the loop, where SwiftShader would run it in every step.
void main() {
  traverse();
  if (!HAS_COLOURS || hit.w == 0u || colours == NOTHING) return;
  uint colour = colour_of();
  if (colour != NOTHING) hit.w |= 128u | colour << 8u;
}`;

const SHADE = RAYS + `
precision highp usampler2D;
uniform usampler2D hits, sets, colours;  // colours[layer]: sRGB, 8 bits each
uniform int mode, step;  // step: pixels between the hits that a normal compares
uniform float pixelSize;  // at distance 1
uniform vec3 light, background;
uniform ivec4 picked;     // a cube and its side; side 0: none
uniform int shownLevels;
out vec4 colour;

const uint HIDDEN = 0xffffffffu;

vec3 position(uvec4 hit) {
  int side = 1 << (levels - int(hit.w & 31u));
  return vec3(ivec3(hit.xyz & 0xfffffu) - eyeCell) - eyeFraction + .5 * float(side);
}
vec3 linear(vec3 c) { return c * c * (.3 * c + .7); }
vec3 ramp(float v) {  // dark blue, green, yellow
  v = clamp(v, 0., 1.);
  return mix(mix(vec3(.06, .02, .2), vec3(.02, .35, .3), min(2. * v, 1.)), vec3(.95, .8, .08), max(2. * v - 1., 0.));
}

// The sum of differences of positions along a line through the pixel; at an edge, of one side.
vec3 across(ivec2 at, ivec2 direction, vec3 here, float limit) {
  vec3 sum = vec3(0);
  ivec2 size = textureSize(hits, 0);
  for (int side = -1; side <= 1; side += 2) {
    for (int i = 1; i <= 3; ++i) {
      ivec2 there = clamp(at + side * i * step * direction, ivec2(0), size - 1);
      uvec4 other = texelFetch(hits, there, 0);
      if (other.w == 0u) break;
      vec3 off = position(other) - here;
      if (dot(off, off) > limit * limit * float(i * i)) break;
      sum += float(side) * off;
    }
  }
  return sum;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec4 hit = texelFetch(hits, at, 0);
  vec3 to = float_direction(pixel());
  if (hit.w == 0u) {
    colour = vec4(background, 1);
    return;
  }
  int side = 1 << (levels - int(hit.w & 31u));
  int axis = int(hit.w >> 5u & 3u);
  uint set = hit.y >> 20u | hit.z >> 20u << 12u;
  uint layer = texelFetch(sets, ivec2(set & 1023u, set >> 10u), 0).r;
  vec3 here = position(hit);
  float distance = length(here), cell = float(side) / (distance * pixelSize);
  vec3 face = vec3(0);
  face[axis] = to[axis] < 0. ? 1. : -1.;
  float limit = 4. * max(float(side), distance * pixelSize * float(step)) * 1.8;
  vec3 dx = across(at, ivec2(1, 0), here, limit), dy = across(at, ivec2(0, 1), here, limit);
  vec3 normal = cross(dx, dy);
  normal = dot(normal, normal) > 1e-12 * dot(dx, dx) * dot(dy, dy) ? normalize(normal) : face;
  if (dot(normal, to) > 0.) normal = -normal;
  normal = normalize(mix(normal, face, smoothstep(2., 6., cell)) + 1e-4 * face);

  vec3 base = vec3(.62, .6, .56);
  if (layer < 0x10000u && mode == 1) {
    uint c = texelFetch(colours, ivec2(layer & 1023u, layer >> 10u), 0).r;
    base = linear(vec3(c & 255u, c >> 8u & 255u, c >> 16u & 255u) / 255.);
  }
  if ((hit.w & 128u) != 0u && mode == 5) base = linear(vec3(hit.w >> 8u & 255u, hit.w >> 16u & 255u, hit.w >> 24u) / 255.);
  float shade = .28 + .72 * max(dot(normal, light), 0.) + .12 * normal[axis];
  vec3 lit = base * max(shade, .12);
  if (mode == 2) lit = linear(.5 + .5 * normal);
  if (mode == 3) lit = ramp(float(int(hit.w & 31u)) / float(shownLevels)) * max(shade, .12) * 1.3;
  if (mode == 4) lit = ramp(log2(1. + float(hit.x >> 20u)) / 8.);

  if (cell > 8.) {  // the edges of large cells
    ivec3 corner = ivec3(hit.xyz & 0xfffffu) - eyeCell;
    vec3 plane = vec3(corner) - eyeFraction + (face + 1.) * .5 * float(side);
    vec3 inside = (to * (plane[axis] / to[axis]) - vec3(corner) + eyeFraction) / float(side);
    inside[axis] = .5;
    vec3 edge = min(inside, 1. - inside);
    lit *= mix(1., .72, smoothstep(8., 24., cell) * (1. - smoothstep(.5, 1.5, cell * min(edge.x, min(edge.y, edge.z)))));
  }
  ivec3 voxel = ivec3(hit.xyz & 0xfffffu);
  if (picked.w > 0 && all(greaterThanEqual(voxel, picked.xyz)) && all(lessThan(voxel, picked.xyz + picked.w)))
    lit = mix(lit, vec3(1, .35, 0), .8);
  colour = vec4(sqrt(clamp(lit, 0., 1.)), 1);
}`;

const LIMB = 2 ** 18;

export class Tracer {
  constructor(gl, scene) {
    Object.assign(this, {gl, scene});
    this.trace = this.program(TRACE.replace('OF_SCENE', Boolean(scene.colours)));
    this.shade = this.program(SHADE);
    this.hits = gl.createTexture();
    this.target = gl.createFramebuffer();
    this.sets = this.table([0]);
    this.colours = this.table(scene.layers.map((l) => l.colour[0] | l.colour[1] << 8 | l.colour[2] << 16));
    this.width = this.height = 0;
  }

  program(fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  // A texture of numbers, 1024 in a row.
  table(numbers) {
    const gl = this.gl, rows = Math.max(1, Math.ceil(numbers.length / 1024)), words = new Uint32Array(1024 * rows);
    words.set(numbers);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32UI, 1024, rows, 0, gl.RED_INTEGER, gl.UNSIGNED_INT, words);
    this.nearest(gl.TEXTURE_2D);
    return texture;
  }

  nearest(target) {
    const gl = this.gl;
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  // `layer_of[set]`: the first layer of the set that is shown; 0xfffffffe: none, but shown;
  // 0xffffffff: hidden.
  showSets(layer_of) {
    this.gl.deleteTexture(this.sets);
    this.sets = this.table(layer_of);
    this.someHidden = layer_of.includes(0xffffffff);
  }

  resize(width, height) {
    if (width === this.width && height === this.height) return;
    const gl = this.gl;
    Object.assign(this, {width, height});
    gl.bindTexture(gl.TEXTURE_2D, this.hits);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32UI, width, height, 0, gl.RGBA_INTEGER, gl.UNSIGNED_INT, null);
    this.nearest(gl.TEXTURE_2D);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.hits, 0);
  }

  use(program, camera) {
    const gl = this.gl, at = (name) => gl.getUniformLocation(program, name);
    gl.useProgram(program);
    const high = [], low = [];
    const {first, right, down} = camera.rays(this.width, this.height, this.shift);
    for (const v of [...first, ...right, ...down]) {
      const h = Math.floor(v * LIMB);
      high.push(h);
      low.push(Math.round((v * LIMB - h) * LIMB));
    }
    const cell = camera.eye.map((v) => Math.max(-(2 ** 29), Math.min(2 ** 29, Math.floor(v))));
    gl.uniform3iv(at('high'), high);
    gl.uniform3iv(at('low'), low);
    gl.uniform3iv(at('eyeCell'), cell);
    gl.uniform3fv(at('eyeFraction'), camera.eye.map((v, a) => v - cell[a]));
    gl.uniform1i(at('levels'), this.scene.levels);
    gl.uniform1i(at('height'), this.height);
    return at;
  }

  bind(at, name, unit, target, texture) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, texture);
    gl.uniform1i(at(name), unit);
    gl.activeTexture(gl.TEXTURE0);
  }

  // Traces a picture of width x height pixels. `clip`: [min, max], in voxels.
  draw(tiles, camera, clip, width, height, shift = [0.5, 0.5]) {
    const gl = this.gl;
    this.shift = shift;
    this.resize(width, height);
    const at = this.use(this.trace, camera);
    this.bind(at, 'pool', 1, gl.TEXTURE_2D_ARRAY, tiles.pool.texture);
    this.bind(at, 'sets', 2, gl.TEXTURE_2D, this.sets);
    gl.uniform1ui(at('top'), tiles.top);
    gl.uniform3iv(at('clipMin'), clip[0]);
    gl.uniform3iv(at('clipMax'), clip[1]);
    gl.uniform1i(at('someHidden'), this.someHidden);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(0, 0, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Shades the last picture into the canvas. `look`: {mode, light, background, picked}; `share`: its
  // part of the mean with what the canvas shows.
  show(camera, look, share = 1) {
    const gl = this.gl;
    const at = this.use(this.shade, camera);
    this.bind(at, 'hits', 1, gl.TEXTURE_2D, this.hits);
    this.bind(at, 'sets', 2, gl.TEXTURE_2D, this.sets);
    this.bind(at, 'colours', 3, gl.TEXTURE_2D, this.colours);
    gl.uniform1i(at('mode'), look.mode);
    gl.uniform1i(at('step'), Math.max(1, Math.round(this.height / 700)));
    gl.uniform1i(at('shownLevels'), this.scene.shown_levels);
    gl.uniform1f(at('pixelSize'), camera.pixel(this.height));
    gl.uniform3fv(at('light'), look.light);
    gl.uniform3fv(at('background'), look.background);
    gl.uniform4iv(at('picked'), look.picked ?? [0, 0, 0, 0]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.width, this.height);
    gl.enable(gl.BLEND);
    gl.blendColor(0, 0, 0, share);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.BLEND);
  }

  // The hits of a part of the last picture, from the lower left, 4 words each; w is 0 without one:
  //   x, y, z   low 20 bits: the cell's corner; high 12 bits: steps; low and high bits of the set
  //   w         low 5 bits: the cell's level; bits 5, 6: the axis of the face that the ray entered;
  //             bit 7: it has a colour; bits 8 to 31: red, green, blue
  read(x = 0, y = 0, width = this.width, height = this.height) {
    const gl = this.gl, words = new Uint32Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.readPixels(x, y, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, words);
    return words;
  }
}
