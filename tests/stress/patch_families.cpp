// Families of near-planar patches (builder/descend/patch.h): walls of many triangles that are one
// plane, nearly one plane, or only similar to one.
#include <cmath>

#include "tests/stress/family.h"

namespace svdag {
namespace {

// A tilted wall: heights along w over a jittered lattice of k x k quads across the region.
struct Wall {
  int w;
  int64_t step;     // of the lattice
  double slope[2];  // along u and v
  int64_t noise;    // of a height, lattice steps
  int64_t at[3];    // a point of the wall

  LatticePoint vertex(int64_t i, int64_t j, StressRandom* random, bool jitter) const {
    const int u = (w + 1) % 3, v = (w + 2) % 3;
    LatticePoint p;
    p[u] = at[u] + i * step + (jitter ? random->around(step / 4) : 0);
    p[v] = at[v] + j * step + (jitter ? random->around(step / 4) : 0);
    p[w] = at[w] + std::llrint(slope[0] * double(p[u] - at[u]) + slope[1] * double(p[v] - at[v])) +
           random->around(noise);
    return p;
  }
};

Wall draw_wall(const Spot& spot, StressRandom* random) {
  Wall wall;
  wall.w = random->axis();
  wall.step = random->log_between(2 * spot.voxel(), 24 * spot.voxel());
  const LatticePoint at = random->coin() ? spot.anchor(random) : spot.corner(random);
  for (int a = 0; a < 3; ++a) wall.at[a] = at[a];
  const uint64_t kind = random->below(4);
  for (double& slope : wall.slope) {
    slope = kind == 0 ? 0 : kind == 1 ? double(random->around(4)) / 4 : 2 * random->unit() - 1;
  }
  static constexpr int64_t kNoise[4] = {0, 1, 20, 3000};
  wall.noise = kNoise[random->below(4)];
  return wall;
}

Soup tessellated(const Wall& wall, StressRandom* random) {
  constexpr int64_t kHalf = 2, kSide = 2 * kHalf + 1;
  const bool jitter = random->coin();
  std::vector<LatticePoint> vertices;
  for (int64_t i = -kHalf; i <= kHalf; ++i) {
    for (int64_t j = -kHalf; j <= kHalf; ++j) vertices.push_back(wall.vertex(i, j, random, jitter));
  }
  const auto at = [&](int64_t i, int64_t j) { return vertices[size_t(i * kSide + j)]; };
  Soup soup;
  for (int64_t i = 0; i + 1 < kSide; ++i) {
    for (int64_t j = 0; j + 1 < kSide; ++j) {
      const LatticePoint a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      if (random->coin()) {
        soup.push_back({{a, b, c}});
        soup.push_back({{a, c, d}});
      } else {
        soup.push_back({{a, b, d}});
        soup.push_back({{b, c, d}});
      }
    }
  }
  return soup;
}

Soup walls(const Spot& spot, StressRandom* random) {
  return tessellated(draw_wall(spot, random), random);
}

// Walls with triangles that are missing, repeated, or folded over an edge onto their neighbour.
Soup damaged_walls(const Spot& spot, StressRandom* random) {
  Soup soup = walls(spot, random);
  for (int i = 0; i < 4; ++i) {
    const size_t k = random->below(soup.size());
    switch (random->below(3)) {
      case 0:
        soup.erase(soup.begin() + int64_t(k));
        break;
      case 1:
        soup.push_back(soup[k]);
        break;
      default: {  // a fold: the third vertex on the other side of one of its edges
        LatticeTriangle& t = soup[k];
        t.v[2] = t.v[0] + t.v[1] - t.v[2];
      }
    }
  }
  return soup;
}

// Thin pairs that share their long diagonal: their boxes contain many voxels that they do not
// touch.
Soup rhombs(const Spot& spot, StressRandom* random) {
  Wall wall = draw_wall(spot, random);
  wall.step = random->log_between(4 * spot.voxel(), 12 * spot.voxel());
  const int u = (wall.w + 1) % 3, v = (wall.w + 2) % 3;
  Soup soup;
  for (int k = 0; k < 6; ++k) {
    const LatticePoint a = wall.vertex(random->around(2), random->around(2), random, true);
    LatticePoint c = wall.vertex(random->around(2), random->around(2), random, true);
    const auto beside = [&](int64_t side) {
      LatticePoint p = (a + c) / int64_t(2);
      p[u] -= side * (c[v] - a[v]) / 16;
      p[v] += side * (c[u] - a[u]) / 16;
      p[wall.w] = wall.at[wall.w] + std::llrint(wall.slope[0] * double(p[u] - wall.at[u]) +
                                                wall.slope[1] * double(p[v] - wall.at[v]));
      return p;
    };
    soup.push_back({{a, c, beside(1)}});
    soup.push_back({{a, c, beside(-1)}});
  }
  return soup;
}

// Two large triangles that share an edge, the diagonal of a quad: exactly or nearly flat, or with
// the second triangle folded over.
Soup quads(const Spot& spot, StressRandom* random) {
  Wall wall = draw_wall(spot, random);
  wall.step = random->log_between(64 * spot.voxel(), int64_t(1) << 34);
  const LatticePoint a = wall.vertex(-1, -1, random, true), b = wall.vertex(1, -1, random, true),
                     c = wall.vertex(1, 1, random, true), d = wall.vertex(-1, 1, random, true);
  const LatticePoint fourth = random->below(4) == 0 ? a + c - d : d;
  return {{{a, b, c}}, {{a, c, fourth}}};
}

}  // namespace

std::vector<Family> patch_families() {
  return {{"tessellated walls", walls},
          {"damaged walls", damaged_walls},
          {"thin rhombs", rhombs},
          {"quads", quads}};
}

}  // namespace svdag
