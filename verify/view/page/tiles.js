// The tiles in the memory of the GPU: loads what a view needs, coarse first, and evicts what has
// not been seen for longest. The format is described in verify/view/tile_file.h.
//
// Memory is one texture of 32-bit words. A tile takes whole rows of it, and the offsets in its
// nodes are replaced by addresses. A pointer is an address and two flags: BRICK for a brick, ENTRY
// for three words, a pointer to a node, the layer value of its cube, and its colours. The first rows
// hold the top tree, nodes whose children are such entries: which tile is drawn where. An octant
// without a tile of its own is drawn by its parent's, so there are no holes.
//
// The colours of a tile (verify/view/tile_colours.h) take rows of their own, after its voxels are
// there; a node has their number in its cube above its child mask. They are described by four
// words: pointer to the tile's root, address of the first, level of the tile, level of the cubes.
// Until they come, and where they are no finer, the tile shows those of the tile above.

export const ROW = 1024;  // words
const LAYER_ROWS = 2048;  // of the array texture: 8 MiB
const TOP_ROWS = 256;
const BRICK = 0x80000000, ENTRY = 0x40000000, SET = 0x80000000, NOTHING = 0xffffffff;
const RECENT = 8;  // passes of a moving view after which a tile that is not seen is drawn no more
const MAX_REQUESTS = 6;

const popcount = (mask) => {
  let n = 0;
  for (; mask; mask &= mask - 1) ++n;
  return n;
};

// Rows of an array texture, which doubles its layers up to the budget.
class Pool {
  constructor(gl, budget) {
    this.gl = gl;
    this.layers = 1;
    const limit = Math.min(256, gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS));  // of addresses, of the GPU
    this.maxLayers = Math.max(1, Math.min(limit, Math.floor(budget / (4 * ROW * LAYER_ROWS))));
    this.texture = this.create(1);
    this.free = [[TOP_ROWS, LAYER_ROWS - TOP_ROWS]];  // [first row, rows], none across layers
  }

  get bytes() { return 4 * ROW * LAYER_ROWS * this.layers; }

  create(layers) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.R32UI, ROW, LAYER_ROWS, layers);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  grow() {
    const layers = Math.min(this.maxLayers, 2 * this.layers), gl = this.gl;
    if (layers === this.layers) return false;
    while (gl.getError() !== gl.NO_ERROR);
    const old = this.texture, larger = this.create(layers);
    if (gl.getError() !== gl.NO_ERROR) {  // the GPU has no more memory
      gl.deleteTexture(larger);
      this.maxLayers = this.layers;
      return false;
    }
    const from = gl.createFramebuffer();
    this.texture = larger;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    for (let i = 0; i < this.layers; ++i) {
      gl.framebufferTextureLayer(gl.READ_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, old, 0, i);
      gl.copyTexSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, i, 0, 0, ROW, LAYER_ROWS);
    }
    gl.deleteFramebuffer(from);
    gl.deleteTexture(old);
    for (; this.layers < layers; ++this.layers) this.free.push([this.layers * LAYER_ROWS, LAYER_ROWS]);
    return true;
  }

  // The first of `rows` successive rows, or -1.
  take(rows) {
    const i = this.free.findIndex(([, count]) => count >= rows);
    if (i < 0) return -1;
    const [row, count] = this.free[i];
    if (count === rows) this.free.splice(i, 1);
    else this.free[i] = [row + rows, count - rows];
    return row;
  }

  give(row, rows) {
    let i = this.free.findIndex(([first]) => first > row);
    if (i < 0) i = this.free.length;
    this.free.splice(i, 0, [row, rows]);
    for (const k of [i, i - 1]) {
      if (k < 0 || k + 1 >= this.free.length) continue;
      const [a, n] = this.free[k], [b, m] = this.free[k + 1];
      if (a + n === b && b % LAYER_ROWS !== 0) this.free.splice(k, 2, [a, n + m]);
    }
  }

  write(row, words) {
    const gl = this.gl, rows = Math.ceil(words.length / ROW);
    const padded = words.length === rows * ROW ? words : new Uint32Array(rows * ROW);
    if (padded !== words) padded.set(words);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.texture);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, row % LAYER_ROWS, Math.floor(row / LAYER_ROWS), ROW, rows, 1,
                     gl.RED_INTEGER, gl.UNSIGNED_INT, padded);
  }
}

// Checks the words of a tile, and returns where its parts are.
function parse(words) {
  const fail = () => { throw new Error('a damaged tile'); };
  if (words.length < 22 || words[0] !== 0x31545653) fail();
  let hash = 0x811c9dc5;
  for (let i = 2; i < words.length; ++i) hash = Math.imul(hash ^ words[i], 0x01000193);
  const count = words[2] - 1;
  if (hash >>> 0 !== words[1] || count < 2 || count > 8) fail();
  const finer = [];
  for (let c = 0; c < 8; ++c) finer.push(words[6 + 2 * c] + words[7 + 2 * c] * 2 ** 32);
  const begin = 22 + count, sections = [];
  let at = begin;
  for (let d = 0; d < count; ++d) {
    sections.push(at);
    at += words[22 + d];
  }
  const layers = at, sets = layers + words[4];
  if (sets + words[5] !== words.length) fail();
  sections.push(layers);
  for (let d = 0; d + 1 < count; ++d) {
    for (let i = sections[d]; i < sections[d + 1];) {
      const children = popcount(words[i] & 0xff);
      if (words[i] === 0 || words[i] > 0xff || i + 1 + children > sections[d + 1]) fail();
      for (const end = i + children; i++ < end;) {
        if (words[i] >= words[23 + d]) fail();
      }
    }
  }
  if (words[22] === 0 || words[21 + count] % 2 !== 0 || words[4] % 8 !== 0) fail();
  const members = [];
  for (let i = sets; i < words.length; i += 1 + words[i]) members.push([...words.subarray(i + 1, i + 1 + words[i])]);
  const check = (value, end) => {
    if (value === NOTHING) return;
    if (value >= SET ? value - SET >= members.length : value % 8 !== 0 || value >= end) fail();
  };
  check(words[3], words[4]);
  for (let i = 0; i < words[4]; ++i) check(words[layers + i], i - i % 8);
  return {words, begin, sections, layers, finer, members};
}

// The number of covered cubes `depth` levels below the root, in the cube of each node, by place.
function countCubes({words, sections}, depth) {
  const counts = new Uint32Array(words.length), bricks = sections.length - 2;
  for (let d = bricks; d >= 0; --d) {
    for (let i = sections[d]; i < sections[d + 1];) {
      const node = i, children = d < bricks ? popcount(words[i]) : 1;
      if (d >= depth) {
        counts[node] = 1;
      } else if (d < bricks) {
        for (let c = 1; c <= children; ++c) counts[node] += counts[sections[d + 1] + words[i + c]];
      } else if (depth - d === 2) {
        counts[node] = popcount(words[i]) + popcount(words[i + 1]);
      } else {
        for (let b = 0; b < 8; ++b) counts[node] += Number((words[i + (b >> 2)] >>> 8 * (b & 3) & 255) !== 0);
      }
      i += 1 + children;
    }
  }
  return counts;
}

export class Tiles {
  // `source`: {scene, tile(id), colours(id, level)}, of which two give promises of words, requested
  // again after an error with `retry`; `changed()` is called when a tile or its colours have come.
  constructor(gl, source, budget, changed) {
    Object.assign(this, {source, changed});
    this.pool = new Pool(gl, budget);
    this.byId = new Map();
    this.pass = 0;
    this.still = 0;      // the pass since which the view has not changed
    this.bytes = 0;      // loaded, before compression
    this.loading = 0;
    this.queue = [];     // tiles to load
    this.sets = [[]];    // number 0: no layer
    this.setNumbers = new Map([['', 0]]);
    this.topKey = '';
    this.root = this.tile(source.scene.root);
  }

  get count() { return [...this.byId.values()].filter((t) => t.state === 'ready' && t.octants).length; }
  get usedBytes() {
    let rows = TOP_ROWS;
    for (const tile of this.byId.values()) rows += tile.rows;
    return 4 * ROW * rows;
  }

  tile(id) {
    let tile = this.byId.get(id);
    if (!tile) {
      tile = {id, state: 'absent', seen: 0, wanted: 0, rows: 0, octants: Array(8).fill(null)};
      this.byId.set(id, tile);
    }
    return tile;
  }

  // Notes what a picture shows. `hits`: of its pixels, 4 words each (trace.js); `level(x, y, z)`:
  // the level that a voxel needs; `same`: the view is the last picture's, whose requests stay.
  // Returns whether more is to come.
  look(hits, level, same) {
    ++this.pass;
    if (!same) this.still = this.pass;
    const {levels, tile_levels: depth} = this.source.scene;
    const absent = new Set(), uncoloured = new Set();
    // Notes that a pixel needs a tile or its colours; returns whether they are there.
    const need = (item, k, missing) => {
      item.seen = this.pass;
      if (item.state === 'ready') return true;
      if (item.wanted !== this.pass) [item.wanted, item.pixels, item.level] = [this.pass, 0, k];
      ++item.pixels;
      missing.add(item);
      return false;
    };
    const see = (x, y, z) => {
      const needed = level(x, y, z);
      let tile = this.root, colours = null;
      for (let k = 0; need(tile, k, absent); ++k) {
        if (tile.colours && !(colours?.cubes >= tile.colours.cubes)) colours = tile.colours;
        if (k === 0 && colours) need(colours, 0, absent);
        const s = levels - 1 - k, c = (x >> s & 1) << 2 | (y >> s & 1) << 1 | z >> s & 1;
        if (k + depth >= needed || !tile.finer[c]) {
          if (colours) need(colours, k, uncoloured);
          return;
        }
        tile = tile.octants[c] ??= this.tile(tile.finer[c]);
      }
    };
    if (this.root.state !== 'ready') see(0, 0, 0);
    for (let i = 0; i < hits.length; i += 4) {
      if (hits[i + 3]) see(hits[i] & 0xfffff, hits[i + 1] & 0xfffff, hits[i + 2] & 0xfffff);
    }
    if (this.full) this.full = !this.oldest();
    const missing = (items) => this.full ? [] : [...items].filter((t) => t.state !== 'failed');
    let open = missing(absent);
    if (open.length === 0) open = missing(uncoloured);
    this.queue = [...new Set([...same ? this.queue : [], ...open])].filter((t) => t.state === 'absent');
    this.queue.sort((a, b) => a.level - b.level || b.pixels - a.pixels);
    this.request();
    return this.update() || open.length > 0 || this.queue.length > 0 || this.loading > 0;
  }

  request() {
    while (this.loading < MAX_REQUESTS && this.queue.length > 0) {
      const tile = this.queue.shift();
      if (tile.state !== 'absent') continue;
      tile.state = 'loading';
      ++this.loading;
      this.load(tile)
        .catch(async (error) => {
          // A server that is being restarted answers again; a damaged tile stays damaged.
          if (error.retry) await new Promise((resolve) => setTimeout(resolve, 1000));
          else this.error = error;
          tile.state = error.retry ? 'absent' : 'failed';
        })
        .finally(() => {
          --this.loading;
          this.request();
          this.changed();
        });
    }
  }

  // Loads a tile or the colours of one.
  async load(item) {
    if (item.octants) this.insert(item, parse(await this.source.tile(item.id)));
    else this.insertColours(item, await this.source.colours(item.tile.id, item.cubes));
  }

  // The first of `rows` rows for a tile or its colours, or -1.
  take(rows, item) {
    if (rows > LAYER_ROWS - TOP_ROWS) throw new Error('a tile is too large');
    let row;
    while ((row = this.pool.take(rows)) < 0) {
      if (!this.pool.grow() && !this.evict()) {
        item.state = 'absent';
        this.full = true;  // until a view needs less
        this.queue = [];
        break;
      }
    }
    return row;
  }

  insertColours(item, words) {
    if (words.length !== item.count) throw new Error('damaged colours');
    if (item.tile.colours !== item) return;  // the tile has been evicted
    const rows = Math.ceil(words.length / ROW), row = this.take(rows, item);
    if (row < 0) return;
    if (item.tile.colours !== item) return this.pool.give(row, rows);
    this.pool.write(row, words);
    this.bytes += 4 * words.length;
    Object.assign(item, {state: 'ready', row, rows});
  }

  // The number of colours per node, of the finest level that they exist at and that has room.
  coloursOf(tile, parsed) {
    const {colours, tile_levels: depth} = this.source.scene;
    if (!colours || colours.root_only && tile !== this.root) return null;
    let cubes = Math.min(colours.level, tile.level + depth);
    for (cubes -= (colours.level - cubes) % 2; cubes >= Math.max(1, tile.level); cubes -= 2) {
      const counts = countCubes(parsed, cubes - tile.level), count = counts[parsed.sections[0]];
      if (count > colours.max) continue;
      tile.colours = {tile, cubes, count, state: 'absent', seen: 0, wanted: 0, rows: 0};
      this.byId.set(`${tile.id}/colours`, tile.colours);
      return counts;
    }
    return null;
  }

  insert(tile, parsed) {
    const {words, begin, sections, layers} = parsed;
    const rows = Math.ceil((words.length - begin) / ROW), row = this.take(rows, tile);
    if (row < 0) return;
    const counts = this.coloursOf(tile, parsed);
    const base = row * ROW - begin, count = sections.length - 1;
    const out = words.slice();
    for (let d = 0; d + 1 < count; ++d) {
      const flag = d + 2 === count ? BRICK : 0;
      for (let i = sections[d]; i < sections[d + 1];) {
        const end = i + popcount(words[i]);
        if (counts) out[i] |= counts[i] << 8;
        while (i++ < end) out[i] = base + sections[d + 1] + words[i] + flag;
      }
    }
    const numbers = parsed.members.map((members) => this.setNumber(members));
    const value = (v) => v === NOTHING ? SET : v >= SET ? SET + numbers[v - SET] : base + layers + v;
    for (let i = layers; i < layers + words[4]; ++i) out[i] = value(words[i]);
    this.pool.write(row, out.subarray(begin));
    this.bytes += 4 * words.length;

    // The root is the last, and only, node of its section.
    const root = sections[0], mask = words[root], layerRoot = value(words[3]);
    const nodes = Array(8).fill(0), octantLayers = Array(8).fill(layerRoot);
    for (let c = 0, i = root + 1; c < 8; ++c) {
      if (mask >> c & 1) nodes[c] = out[i++];
      if (words[3] < SET) octantLayers[c] = out[layers + words[3] + c];
    }
    Object.assign(tile, {state: 'ready', row, rows, mask, nodes, layerRoot, octantLayers, finer: parsed.finer,
                         pointer: base + root});
  }

  // The tile that was seen least recently, before this pass; not the root.
  oldest() {
    let oldest = null;
    for (const tile of this.byId.values()) {
      if (tile.state !== 'ready' || tile === this.root || tile.seen >= this.pass) continue;
      if (!oldest || tile.seen < oldest.seen) oldest = tile;
    }
    return oldest;
  }

  evict() {
    const oldest = this.oldest();
    if (!oldest) return false;
    this.pool.give(oldest.row, oldest.rows);
    Object.assign(oldest, {state: 'absent', rows: 0});
    if (oldest.octants) {
      oldest.octants = Array(8).fill(null);
      const colours = oldest.colours;
      if (colours?.rows) this.pool.give(colours.row, colours.rows);
      if (colours) this.byId.delete(`${oldest.id}/colours`);
      oldest.colours = null;
    }
    this.update();
    return true;
  }

  setNumber(members) {
    const key = members.join();
    let number = this.setNumbers.get(key);
    if (number === undefined) {
      number = this.sets.push(members) - 1;
      this.setNumbers.set(key, number);
    }
    return number;
  }

  // Rebuilds the top tree; returns whether it differs.
  update() {
    if (this.root.state !== 'ready') return false;
    const drawn = (t) => t && t.state === 'ready' && this.still - t.seen <= RECENT;
    const out = [], done = new Map();
    const entry = (node, layers, colours) => out.push(node >>> 0, layers >>> 0, colours ? colours.address : NOTHING) - 3 + ENTRY;
    const build = (tile, k, colours) => {
      let pointer = done.get(tile.id);
      if (pointer !== undefined) return pointer;
      const own = tile.colours;
      if (own?.state === 'ready' && !(colours?.cubes >= own.cubes))
        colours = {cubes: own.cubes, address: out.push(tile.pointer, own.row * ROW, k, own.cubes) - 4};
      if (!tile.octants.some(drawn) || out.length > (TOP_ROWS - 1) * ROW) {
        pointer = entry(tile.pointer, tile.layerRoot, colours);
      } else {
        const node = [tile.mask];
        for (let c = 0; c < 8; ++c) {
          if (!(tile.mask >> c & 1)) continue;
          const octant = tile.octants[c];
          node.push(drawn(octant) ? build(octant, k + 1, colours) : entry(tile.nodes[c], tile.octantLayers[c], colours));
        }
        pointer = out.push(...node) - node.length;
      }
      done.set(tile.id, pointer);
      return pointer;
    };
    this.top = build(this.root, 0, null);
    const key = out.join();
    if (key === this.topKey) return false;
    this.topKey = key;
    this.pool.write(0, Uint32Array.from(out));
    return true;
  }
}
