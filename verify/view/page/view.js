// The viewer: canvas, panel, and what mouse, touch, keys and the URL do.
import {Camera} from './camera.js';
import {Tiles} from './tiles.js';
import {Tracer} from './trace.js';

const AXES = ['x', 'y', 'z'];
const MODES = ['surface', 'layer', 'normal', 'level', 'steps', 'colour'], COLOUR = 5;
const NO_LAYER = 0xfffffffe, HIDDEN = 0xffffffff;
const HELP = 'Drag: turn. Shift or right drag, two fingers: move. Wheel, + and -: zoom. Arrows: turn. W A S D Q E: fly. ' +
  'F: turn around the eye. Home: all. Click: pick a voxel.';

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

const grouped = (n) => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, ',');
const megabytes = (n) => `${(n / 2 ** 20).toFixed(1)} MB`;

// Starts a viewer in `parent`. `source`: see Tiles. Returns it, or null
// where WebGL2 is missing, which the page then reports.
export function start(parent, source) {
  const canvas = element('canvas', {tabIndex: 0});
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', `Voxels of ${source.scene.name}. ${HELP}`);
  const gl = canvas.getContext('webgl2', {antialias: false, alpha: false, preserveDrawingBuffer: true});
  if (!gl) {
    parent.append(element('p', {className: 'message', textContent: 'This browser does not offer WebGL2, which the viewer ' +
      'needs. Enable hardware acceleration, or use a current Firefox, Chrome, Edge or Safari.'}));
    return null;
  }
  return new Viewer(parent, canvas, gl, source);
}

class Viewer {
  constructor(parent, canvas, gl, source) {
    Object.assign(this, {parent, canvas, gl, source, scene: source.scene});
    const scene = this.scene;
    this.camera = new Camera(scene.up, scene.bounds);
    this.size = 2 ** scene.levels;
    this.clip = scene.bounds.map((corner) => [...corner]);
    this.mode = scene.colours ? COLOUR : scene.layers.length > 0 ? 1 : 0;
    this.hidden = new Set();   // layers
    this.detail = 1;           // pixels per cell; 0: every voxel
    this.budget = 256 * 2 ** 20;
    this.scale = 1;            // of the picture while it changes
    this.samples = 8;          // rays per pixel of a picture that does not change
    this.keys = new Set();
    this.readUrl();
    this.tiles = new Tiles(gl, source, this.budget, () => this.tileCame());
    this.tracer = new Tracer(gl, scene);
    this.first = null;         // {seconds, bytes} of the first picture
    this.settled = false;
    this.listeners = [];
    this.makePanel();
    parent.append(canvas, this.panel, this.message = element('p', {className: 'message'}));
    this.message.setAttribute('role', 'status');
    this.setLayers();
    this.listen();
    this.tiles.look([], () => 0, false);
    this.drawnAt = 0;
    window.viewer = this;  // for the console and tests
  }

  // --- drawing

  redraw() {
    this.settled = false;
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame((time) => {
      this.scheduled = false;
      this.frame(time);
    });
  }

  report(text) {
    this.message.textContent = text;
  }

  // Pictures of a still view wait for several tiles.
  tileCame() {
    if (this.tiles.queue.length === 0 || performance.now() - this.drawnAt > 500) this.redraw();
  }

  // While anything changes, pictures are small enough to follow; the last one has every pixel.
  frame(time) {
    if (this.tiles.error) this.report(`A part of the scene cannot be loaded: ${this.tiles.error.message}`);
    if (this.tiles.root.state !== 'ready') {
      this.tiles.look([], () => 0, true);  // requests it again after an error of the network
      return;
    }
    const moving = this.fly(time) || this.pressed || performance.now() - (this.touchedAt ?? -1e9) < 200;
    const begin = performance.now();
    const more = this.draw(moving || this.pending ? this.scale : 1, !moving);
    this.drawnAt = performance.now();
    const seconds = (this.drawnAt - begin) / 1000;
    if (moving || this.pending) this.scale = Math.max(0.1, Math.min(1, this.scale * Math.sqrt(0.04 / seconds)));
    const whole = !moving && !this.pending;
    this.pending = more;
    this.first ??= {seconds: performance.now() / 1000, bytes: this.tiles.bytes};
    this.showStatus(seconds);
    if (whole && !more) {
      this.settle();
      this.refine(1);
    } else if (moving || whole || !more || this.tiles.loading === 0) {
      this.redraw();  // else the next tile does
    }
  }

  // Adds the rays of other places in the pixels, one per frame, until something changes.
  refine(sample) {
    this.sample = sample;
    if (sample >= this.samples) return;
    requestAnimationFrame(() => {
      if (!this.settled) return;
      const {tracer, camera} = this, radical = (base, i) => i === 0 ? 0 : (i % base + radical(base, Math.floor(i / base))) / base;
      tracer.draw(this.tiles, camera, this.clip, tracer.width, tracer.height, [radical(2, sample), radical(3, sample)]);
      tracer.show(camera, this.look(), 1 / (sample + 1));
      this.refine(sample + 1);
    });
  }

  // Draws once and notes which tiles are seen; `same`: the view has not changed. Returns whether a better picture will come.
  draw(scale, same) {
    const canvas = this.canvas, ratio = this.fixedSize ? 1 : window.devicePixelRatio;
    const [w, h] = this.fixedSize ?? [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
    const shrunk = Math.min(scale, 4095 / w, 4095 / h);
    const width = Math.max(1, Math.round(w * shrunk)), height = Math.max(1, Math.round(h * shrunk));
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    this.tracer.draw(this.tiles, this.camera, this.clip, width, height);
    this.tracer.show(this.camera, this.look());
    const eye = this.camera.eye, pixel = this.camera.pixel(h), {levels, shown_levels: shown} = this.scene;
    return this.tiles.look(this.tracer.read(), (x, y, z) => {
      if (this.detail === 0) return shown;
      const away = Math.hypot(x - eye[0], y - eye[1], z - eye[2]);
      return Math.min(shown, Math.ceil(levels - Math.log2(Math.max(1, away * pixel * this.detail))));
    }, same);
  }

  look() {
    const {right, up, forward} = this.camera.frame(), world = [0, 0, 0];
    world[this.scene.up] = 1;
    const light = [0, 1, 2].map((a) => -0.5 * right[a] + 0.5 * up[a] - 0.7 * forward[a] + 0.5 * world[a]);
    const dark = matchMedia('(prefers-color-scheme: dark)').matches;
    return {mode: this.mode, light: light.map((v) => v / Math.hypot(...light)), picked: this.picked?.cube,
            background: dark ? [0.08, 0.09, 0.1] : [0.957, 0.953, 0.941]};
  }

  settle() {
    this.settled = true;
    this.writeUrl();
    for (const listener of this.listeners.splice(0)) listener();
  }

  // Resolves when the picture shows all that the view needs.
  whenSettled() {
    return new Promise((resolve) => {
      this.listeners.push(resolve);
      this.redraw();
    });
  }

  // --- layers

  // Which layer each set of layers shows.
  setLayers() {
    this.tracer.showSets(this.tiles.sets.map((members) => {
      if (members.length === 0) return NO_LAYER;
      return members.find((layer) => !this.hidden.has(layer)) ?? HIDDEN;
    }));
    this.setCount = this.tiles.sets.length;
  }

  // --- the panel

  makePanel() {
    const scene = this.scene;
    this.status = element('div', {className: 'dim'});
    this.picture = element('output', {textContent: 'Click a voxel.'});
    const mode = element('select', {title: 'Colours'}, ...MODES.map((name, i) => element('option', {value: i, textContent: name})));
    mode.options[1].disabled = scene.layers.length === 0;
    mode.options[COLOUR].disabled = !scene.colours;
    mode.value = this.mode;
    mode.onchange = () => { this.mode = Number(mode.value); this.touch(); };
    const button = (textContent, onclick) => element('button', {type: 'button', textContent, onclick});
    this.copyButton = button('Copy', () => navigator.clipboard?.writeText(this.picture.textContent));
    this.copyButton.hidden = true;
    this.panel = element('details', {className: 'panel', open: true}, element('summary', {textContent: scene.name}),
      element('div', {className: 'dim', textContent: `${grouped(this.size)}³, ${grouped(scene.voxels)} voxels, rule ${scene.rule}`}),
      element('h2', {textContent: 'Colours'}),
      element('div', {className: 'row'}, mode, button('All', () => { this.camera.home(); this.touch(); })));
    this.panel.append(element('h2', {textContent: 'Sections'}), ...AXES.map((name, a) => this.section(name, a)));
    if (scene.layers.length > 0) this.panel.append(element('h2', {textContent: 'Layers'}), this.layerList());
    this.panel.append(element('h2', {textContent: 'Voxel'}), this.picture, this.copyButton,
      element('h2', {textContent: 'State'}), this.status, element('div', {className: 'dim', textContent: HELP}));
  }

  section(name, a) {
    const [low, high] = [0, 1].map((i) => this.scene.bounds[i][a]);
    const slider = (i, label) => {
      const input = element('input', {type: 'range', min: low, max: high, step: 1, value: this.clip[i][a]});
      input.setAttribute('aria-label', label);
      input.oninput = () => {
        this.clip[i][a] = Number(input.value);
        this.touch();
      };
      return input;
    };
    return element('label', {}, element('b', {className: 'axis', textContent: name}), slider(0, `${name}: from`), slider(1, `${name}: to`));
  }

  layerList() {
    const row = (index, text, colour) => {
      const box = element('input', {type: 'checkbox', checked: !this.hidden.has(index)});
      box.onchange = () => {
        this.hidden[box.checked ? 'delete' : 'add'](index);
        this.setLayers();
        this.touch();
      };
      const swatch = element('i', {className: 'swatch'});
      swatch.style.background = colour;
      return element('li', {}, element('label', {}, box, swatch, element('span', {textContent: text})));
    };
    const list = element('ul', {className: 'layers'}, ...this.scene.layers.map((layer, i) => row(i, layer.name, `rgb(${layer.colour})`)));
    const boxes = [...list.querySelectorAll('input')];
    const show = (shown) => {
      boxes.forEach((box, i) => {
        box.checked = shown(i);
        this.hidden[box.checked ? 'delete' : 'add'](i);
      });
      this.setLayers();
      this.touch();
    };
    const none = element('button', {type: 'button', textContent: 'All or none'});
    none.onclick = () => {
      const on = !boxes.every((box) => box.checked);
      show(() => on);
    };
    const one = element('input', {type: 'range', min: 0, max: boxes.length - 1, step: 1, value: 0, title: 'One layer alone'});
    one.setAttribute('aria-label', 'One layer alone');
    one.oninput = () => show((i) => i === Number(one.value));
    return element('div', {}, list, element('div', {className: 'row'}, none, one));
  }

  showStatus(seconds) {
    if (this.tiles.sets.length !== this.setCount) this.setLayers();
    const {tiles} = this;
    this.status.textContent = `${(1000 * seconds).toFixed(0)} ms a picture, ${this.tracer.width} x ${this.tracer.height}; ` +
      `${megabytes(tiles.bytes)} loaded; ${tiles.count} ${tiles.count === 1 ? 'tile' : 'tiles'}, ${megabytes(tiles.usedBytes)} of ${megabytes(this.budget)}` +
      (tiles.full ? '; more detail does not fit in this memory' : this.pending ? '; loading' : '');
  }

  // Shows what is at a pixel of the canvas, from the upper left in CSS pixels.
  pick(x, y) {
    const {tracer, canvas, scene} = this, row = Math.floor(y * tracer.height / canvas.clientHeight);
    const hit = tracer.read(Math.floor(x * tracer.width / canvas.clientWidth), tracer.height - 1 - row, 1, 1);
    this.picked = null;
    this.copyButton.hidden = hit[3] === 0;
    this.picture.textContent = 'Nothing.';
    if (hit[3] !== 0) {
      const voxel = [...hit.subarray(0, 3)].map((v) => v & 0xfffff), level = hit[3] & 31, side = 2 ** (scene.levels - level);
      const set = this.tiles.sets[hit[1] >>> 20 | hit[2] >>> 20 << 12];
      const world = voxel.map((v, a) => scene.corner[a] + (v + side / 2) * scene.voxel_size);
      const colour = hit[3] & 128 ? [8, 16, 24].map((bit) => hit[3] >>> bit & 255) : null;
      this.picked = {voxel, level, cube: [...voxel, side], layers: set, colour};
      this.picture.textContent = `voxel ${voxel.join(', ')}\nlevel ${level} of ${scene.levels}` + (side > 1 ? ` (${side} voxels wide)` : '') +
        `\nat ${world.map((v) => +v.toPrecision(9)).join(', ')}` +
        (colour ? `\ncolour #${colour.map((v) => v.toString(16).padStart(2, '0')).join('')}` : '') +
        (scene.layers.length > 0 ? `\n${set.map((i) => scene.layers[i].name).join('\n') || 'in no layer'}` : '');
    }
    this.touch();
    return this.picked;
  }

  // --- input

  touch() {
    this.touchedAt = performance.now();
    this.redraw();
  }

  listen() {
    const {canvas, camera} = this, pointers = new Map();
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    canvas.addEventListener('webglcontextlost', () => this.report('The browser has lost the memory of the GPU: reload the page.'));
    canvas.addEventListener('pointerdown', (e) => {
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, {x: e.offsetX, y: e.offsetY, moved: 0});
      this.pressed = true;
    });
    canvas.addEventListener('pointermove', (e) => {
      const at = pointers.get(e.pointerId);
      if (!at) return;
      const dx = e.offsetX - at.x, dy = e.offsetY - at.y;
      const others = [...pointers.entries()].filter(([id]) => id !== e.pointerId).map(([, p]) => p);
      if (others.length > 0) {  // two fingers: their distance zooms, their middle moves
        const [o] = others, before = Math.hypot(at.x - o.x, at.y - o.y), after = Math.hypot(e.offsetX - o.x, e.offsetY - o.y);
        if (after > 0) camera.zoom(before / after);
        this.pan(dx / 2, dy / 2);
      } else if (e.shiftKey || e.buttons & 6) {
        this.pan(dx, dy);
      } else {
        camera.turn(dx * -0.008, dy * 0.008, this.flying);
      }
      Object.assign(at, {x: e.offsetX, y: e.offsetY, moved: at.moved + Math.abs(dx) + Math.abs(dy)});
      this.touch();
    });
    const release = (e) => {
      const at = pointers.get(e.pointerId);
      pointers.delete(e.pointerId);
      this.pressed = pointers.size > 0;
      if (e.type === 'pointerup' && at && at.moved < 4) this.pick(e.offsetX, e.offsetY);
      this.touch();
    };
    canvas.addEventListener('pointerup', release);
    canvas.addEventListener('pointercancel', release);
    canvas.addEventListener('wheel', (e) => {
      // Inside another page, the wheel scrolls until the viewer has been clicked.
      if (!this.parent.classList.contains('whole') && document.activeElement !== canvas) return;
      e.preventDefault();
      camera.zoom(Math.exp(Math.max(-1, Math.min(1, e.deltaY / (e.deltaMode ? 10 : 300)))));
      this.touch();
    }, {passive: false});
    canvas.addEventListener('keydown', (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
      if (key === 'Home') camera.home();
      else if (key === 'f') this.flying = !this.flying;
      else if ('wasdqe+=-'.includes(key) || key.startsWith('Arrow')) this.keys.add(key);
      else return;
      e.preventDefault();
      this.touch();
    });
    canvas.addEventListener('keyup', (e) => {
      const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
      for (const each of '+='.includes(key) ? ['+', '='] : [key]) this.keys.delete(each);  // Shift may be released first
    });
    canvas.addEventListener('blur', () => this.keys.clear());
    new ResizeObserver(() => this.touch()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.touch());
    window.addEventListener('hashchange', () => location.reload());  // another view was pasted
  }

  pan(dx, dy) {
    const step = this.camera.distance * this.camera.pixel(this.canvas.clientHeight);
    this.camera.move(-dx * step, dy * step, 0);
  }

  // Moves by the keys that are held; returns whether one is.
  fly(time) {
    const seconds = Math.min(0.2, (time - (this.lastTime ?? time)) / 1000);
    this.lastTime = this.keys.size > 0 ? time : undefined;
    if (this.keys.size === 0) return false;
    const held = (key) => Number(this.keys.has(key)), {camera} = this, step = seconds * camera.distance;
    camera.move(step * (held('d') - held('a')), step * (held('e') - held('q')), step * (held('w') - held('s')));
    camera.turn(seconds * (held('ArrowRight') - held('ArrowLeft')), seconds * (held('ArrowUp') - held('ArrowDown')), this.flying);
    const zoom = held('-') - (held('+') || held('='));
    if (zoom) camera.zoom(Math.exp(zoom * seconds));
    return true;
  }

  // --- the URL keeps the view

  writeUrl() {
    const {scene, camera} = this, world = (p) => p.map((v, a) => +(scene.corner[a] + v * scene.voxel_size).toPrecision(12)).join();
    const parts = {eye: world(camera.eye), to: world(camera.target), fov: camera.fov, colours: MODES[this.mode]};
    if (this.clip.flat().join() !== scene.bounds.flat().join()) parts.clip = this.clip.flat().join();
    if (this.hidden.size > 0) parts.hide = [...this.hidden].join();
    if (this.detail !== 1) parts.detail = this.detail;
    if (this.budget !== 256 * 2 ** 20) parts.memory = this.budget / 2 ** 20;
    this.hash = '#' + Object.entries(parts).map(([name, value]) => `${name}=${value}`).join('&');
    history.replaceState(null, '', this.hash);
  }

  readUrl() {
    if (location.hash === this.hash) return;
    const {scene, camera} = this, parts = new Map(location.hash.slice(1).split('&').map((part) => part.split('=')));
    const numbers = (name, count) => {
      const list = parts.get(name)?.split(',').map(Number);
      return list?.length === count && list.every(Number.isFinite) ? list : null;
    };
    const voxels = (p) => p?.map((v, a) => (v - scene.corner[a]) / scene.voxel_size);
    const eye = voxels(numbers('eye', 3)), to = voxels(numbers('to', 3)), fov = numbers('fov', 1)?.[0] ?? camera.fov;
    if (eye && to && Math.hypot(...eye.map((v, a) => v - to[a])) > 0) camera.look(eye, to, Math.max(1, Math.min(150, fov)));
    const mode = MODES.indexOf(parts.get('colours'));
    if (mode >= 0) this.mode = mode;
    const clip = numbers('clip', 6)?.map((v) => Math.max(0, Math.min(this.size, Math.round(v))));
    if (clip) this.clip = [clip.slice(0, 3), clip.slice(3)];
    if (parts.has('hide')) this.hidden = new Set((parts.get('hide') ?? '').split(',').map(Number).filter(Number.isInteger));
    this.detail = Math.max(0, numbers('detail', 1)?.[0] ?? this.detail);
    this.budget = Math.max(8, numbers('memory', 1)?.[0] ?? this.budget / 2 ** 20) * 2 ** 20;
  }
}
