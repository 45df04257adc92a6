// The scenes that are one grid of quads (or six): scan, terrain, rectangle, sheet.
#include <algorithm>
#include <cmath>

#include "streaming/error.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

// The largest n with n * n <= x.
uint64_t root(uint64_t x) {
  uint64_t n = uint64_t(std::sqrt(double(x)));
  while (n * n > x) --n;
  while ((n + 1) * (n + 1) <= x) ++n;
  return n;
}

// A cube whose faces are n x n grids, blown up to a sphere and displaced along its radius.
// Positions on the cube are integers, so the seams of the six grids meet exactly.
class Scan : public Mesh {
 public:
  Scan(uint64_t n, uint64_t seed) : n_(n), seed_(seed) {}

  uint64_t vertices() const override { return 6 * (n_ + 1) * (n_ + 1); }
  uint64_t faces() const override { return 12 * n_ * n_; }

  Point vertex(uint64_t i) const override {
    const uint64_t side = i / ((n_ + 1) * (n_ + 1)), rest = i % ((n_ + 1) * (n_ + 1));
    const int axis = int(side / 2);
    const double sign = side % 2 == 0 ? 1 : -1;
    Point cube;
    cube[axis] = sign * double(n_);
    // The mirrored grid of the opposite side keeps all faces turned outwards.
    cube[(axis + 1) % 3] = sign * (2 * double(rest % (n_ + 1)) - double(n_));
    cube[(axis + 2) % 3] = 2 * double(rest / (n_ + 1)) - double(n_);
    return displaced(normalised(cube));
  }

  Face face(uint64_t i) const override {
    const uint64_t side = i / (2 * n_ * n_), base = side * (n_ + 1) * (n_ + 1);
    Face f = quad_face(n_, i % (2 * n_ * n_));
    for (uint64_t& v : f) v += base;
    return f;
  }

 private:
  Point displaced(const Point& d) const {
    // + 16 keeps the noise's lattice, and so its creases, away from the symmetry planes.
    const double relief = fractal(seed_, {d.x * 2 + 16.3, d.y * 2 + 16.7, d.z * 2 + 16.1}, 10);
    const double r = 36 * (1 + 0.28 * relief);
    return {d.x * r, d.y * r * 1.5, d.z * r};
  }

  uint64_t n_;
  uint64_t seed_;
};

class Terrain : public Mesh {
 public:
  Terrain(uint64_t n, uint64_t seed) : n_(n), seed_(seed) {}

  uint64_t vertices() const override { return (n_ + 1) * (n_ + 1); }
  uint64_t faces() const override { return 2 * n_ * n_; }

  Point vertex(uint64_t i) const override {
    const double x = double(i / (n_ + 1)) / double(n_), z = double(i % (n_ + 1)) / double(n_);
    const double relief = fractal(seed_, {x * 5, 0.5, z * 5}, 11);
    const double ridges = 1 - std::abs(fractal(seed_ + 1, {x * 3, 0.5, z * 3}, 9));
    return {100 * x - 50, 5 * relief + 9 * ridges * ridges, 100 * z - 50};
  }

  Face face(uint64_t i) const override { return quad_face(n_, i); }

 private:
  uint64_t n_;
  uint64_t seed_;
};

class Rectangle : public Mesh {
 public:
  uint64_t vertices() const override { return 4; }
  uint64_t faces() const override { return 2; }
  Point vertex(uint64_t i) const override {
    const double u = i % 2 == 0 ? -48 : 48, v = i / 2 == 0 ? -48 : 48;
    return {u + 0.125 * v, 0.3125 * u - 0.1875 * v, v - 0.125 * u};
  }
  Face face(uint64_t i) const override { return quad_face(1, i); }
};

// A square with corners +-p, +-q: flat whatever its corners are rounded to. The rectangle's normal
// is a ratio of small integers, so that its voxels repeat after a few steps; those of the sheet do
// not.
class Sheet : public Mesh {
 public:
  Sheet() {
    const Point n = normalised({0.3618033989, 0.4771212547, 0.7993147181});
    const Point aside{0.8414709848, -0.5772156649, 0.2718281828};
    const double along = n.x * aside.x + n.y * aside.y + n.z * aside.z;
    const Point p =
        normalised({aside.x - along * n.x, aside.y - along * n.y, aside.z - along * n.z});
    const Point q{n.y * p.z - n.z * p.y, n.z * p.x - n.x * p.z, n.x * p.y - n.y * p.x};
    p_ = quantised({68 * p.x, 68 * p.y, 68 * p.z});
    q_ = quantised({68 * q.x, 68 * q.y, 68 * q.z});
  }
  uint64_t vertices() const override { return 4; }
  uint64_t faces() const override { return 2; }
  Point vertex(uint64_t i) const override {
    const Point& corner = i == 0 || i == 3 ? p_ : q_;
    return i < 2 ? corner : Point{-corner.x, -corner.y, -corner.z};
  }
  Face face(uint64_t i) const override { return quad_face(1, i); }

 private:
  Point p_, q_;
};

}  // namespace

std::unique_ptr<Mesh> make_scan(uint64_t triangles, uint64_t seed) {
  return std::make_unique<Scan>(std::max<uint64_t>(1, root(triangles / 12)), seed);
}

std::unique_ptr<Mesh> make_terrain(uint64_t triangles, uint64_t seed) {
  return std::make_unique<Terrain>(std::max<uint64_t>(1, root(triangles / 2)), seed);
}

std::unique_ptr<Mesh> make_rectangle(uint64_t triangles, uint64_t) {
  if (triangles != 2) fail_usage("--triangles: a rectangle has 2 triangles");
  return std::make_unique<Rectangle>();
}

std::unique_ptr<Mesh> make_sheet(uint64_t triangles, uint64_t) {
  if (triangles != 2) fail_usage("--triangles: a sheet has 2 triangles");
  return std::make_unique<Sheet>();
}

}  // namespace svdag::scenes
