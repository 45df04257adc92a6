// A pinhole camera in voxel coordinates, in doubles, as verify/trace/kernel/camera.h.

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.sqrt(dot(a, a));
const normalized = (a) => scaled(a, 1 / length(a));
const radians = (degrees) => degrees * Math.PI / 180;

export class Camera {
  // `up`: the axis (0 .. 2) that points up; `bounds`: [min, max] of what is looked at.
  constructor(up, bounds) {
    this.up = up;
    this.bounds = bounds;
    this.size = Math.max(1, length(sub(bounds[1], bounds[0])));
    this.fov = 40;  // degrees, vertical
    this.home();
  }

  // Looks at all of the bounds from above.
  home() {
    this.target = scaled(add(this.bounds[0], this.bounds[1]), 0.5);
    const from = [1, 1, 1];
    from[this.up] = 0.7;
    this.eye = add(this.target, normalized(from), 0.5 * this.size / Math.sin(radians(this.fov / 2)));
  }

  look(eye, target, fov = this.fov) {
    Object.assign(this, {eye, target, fov});
  }

  // Orthonormal; `side` replaces the up axis where the camera looks along it.
  frame() {
    const forward = normalized(sub(this.target, this.eye));
    const world = [0, 0, 0];
    world[this.up] = 1;
    let right = cross(forward, world);
    if (!(length(right) > 1e-9)) {
      const side = [0, 0, 0];
      side[(this.up + 1) % 3] = 1;
      right = cross(forward, side);
    }
    right = normalized(right);
    return {forward, right, up: cross(right, forward)};
  }

  get distance() { return length(sub(this.target, this.eye)); }
  // Size of a pixel at distance 1.
  pixel(height) { return 2 * Math.tan(radians(this.fov / 2)) / height; }

  // Turns by angles: around the target, or around the eye if `fly`.
  turn(right, up, fly) {
    const back = sub(this.eye, this.target);
    const radius = length(back), u = this.up, v = (u + 1) % 3, w = (u + 2) % 3;
    const pitch = Math.asin(Math.max(-1, Math.min(1, back[u] / radius)));
    const limit = radians(89.9), p = Math.max(-limit, Math.min(limit, pitch + up));
    const yaw = Math.atan2(back[w], back[v]) + right;
    const turned = [0, 0, 0];
    turned[u] = radius * Math.sin(p);
    turned[v] = radius * Math.cos(p) * Math.cos(yaw);
    turned[w] = radius * Math.cos(p) * Math.sin(yaw);
    if (fly) this.target = sub(this.eye, turned);
    else this.eye = add(this.target, turned);
  }

  // Moves eye and target by distances along the picture's axes.
  move(right, up, forward) {
    const f = this.frame();
    const step = add(add(scaled(f.right, right), f.up, up), f.forward, forward);
    this.eye = add(this.eye, step);
    this.target = add(this.target, step);
  }

  // Comes closer to the target: factor < 1.
  zoom(factor) {
    const back = sub(this.eye, this.target);
    const radius = Math.min(100 * this.size, Math.max(0.5, length(back) * factor));
    this.eye = add(this.target, normalized(back), radius);
  }

  // The directions of a picture's rays: that of pixel (x, y), counted from the upper left, is
  // first + x * right + y * down. At most 1 in each component, for trace.js. `shift`: where in its
  // pixel a ray is, 0 .. 1.
  rays(width, height, shift) {
    const f = this.frame(), slope = Math.tan(radians(this.fov / 2)), aspect = width / height;
    const longest = Math.sqrt(1 + slope * slope * (1 + aspect * aspect));
    const right = scaled(f.right, 2 * slope * aspect / width / longest);
    const down = scaled(f.up, -2 * slope / height / longest);
    let first = add(add(scaled(f.forward, 1), f.right, -slope * aspect), f.up, slope);
    first = add(add(scaled(first, 1 / longest), right, shift[0]), down, shift[1]);
    return {first, right, down};
  }
}
