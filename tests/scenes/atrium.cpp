// Atrium: a court of 24 m x 9 m between two storeys of arcades, open to the sky, in the manner of
// the palace of Sponza. Most area is axis-aligned; arches, columns, cloth and leaves are not.
#include "tests/scenes/kinds.h"
#include "tests/scenes/masonry.h"

namespace svdag::scenes {
namespace {

constexpr double kBay = 3;                                      // from column to column
constexpr int kLong = 8, kWide = 3;                             // bays
constexpr double kX = kBay * kLong / 2, kZ = kBay * kWide / 2;  // half sides of the court
constexpr double kGallery = 3.6;                                // depth of the galleries
constexpr double kWall = 0.5;                                   // thickness of the outer wall
constexpr double kFloor[] = {0, 5.2, 9.2};                      // of the storeys, and the roof

// The four sides of the court, seen from its middle, from left to right.
struct Side {
  Frame frame;  // a = 0 at the left corner, c towards the court
  int bays;
};
const Side kSides[] = {{{{-kX, 0, -kZ}, {1, 0, 0}, {0, 0, 1}}, kLong},
                       {{{kX, 0, -kZ}, {0, 0, 1}, {-1, 0, 0}}, kWide},
                       {{{kX, 0, kZ}, {-1, 0, 0}, {0, 0, -1}}, kLong},
                       {{{-kX, 0, kZ}, {0, 0, -1}, {1, 0, 0}}, kWide}};

void build_floor(Masonry& m) {
  const double x = kX + kGallery, z = kZ + kGallery;
  const Frame world;
  m.part("floor", "terracotta");
  m.block(world, {-x, -0.5, -z}, {x, 0, z});
  m.part("tile", "mosaic");
  const double pitch = 0.75;
  for (int i = 0; i < int(2 * kX / pitch); ++i) {
    for (int j = 0; j < int(2 * kZ / pitch); ++j) {
      const double a = -kX + pitch * i, c = -kZ + pitch * j;
      m.tile(world, {a + 0.01, 0, c + 0.01}, {a + pitch - 0.01, 0.015, c + pitch - 0.01});
    }
  }
}

void build_arcade(Masonry& m, const Side& side, int storey) {
  const double height = kFloor[storey + 1] - kFloor[storey];
  const double radius = 1.2, band = 0.35;
  const Arch arch{kBay, radius, height - band - radius - 0.35, height - band, 0.56};
  for (int bay = 0; bay < side.bays; ++bay) {
    const Frame f = side.frame.moved(kBay * bay, kFloor[storey], 0);
    m.column(f, arch.spring, storey == 0 ? 0.26 : 0.2);
    m.arch(f, arch);
  }
  // The band between the storeys, its cornice, and the gallery's ceiling.
  const Frame f = side.frame.moved(0, kFloor[storey], 0);
  const double length = kBay * side.bays;
  m.block(f, {0.3, height - band, -kGallery}, {length - 0.3, height, 0.3});
  m.block(f, {0.3, height - 0.12, 0.3}, {length - 0.3, height, 0.42});
  if (storey == 0) return;
  for (int bay = 0; bay < side.bays; ++bay) {  // balustrade of the upper gallery
    const Frame g = f.moved(kBay * bay, 0, 0);
    m.block(g, {0.3, 0.82, -0.1}, {kBay - 0.3, 0.94, 0.1});
    for (int i = 0; i < 8; ++i)
      m.turned(g.moved(0.45 + 0.3 * i, 0, 0), {{0.08, 0},
                                               {0.08, 0.05},
                                               {0.04, 0.12},
                                               {0.09, 0.32},
                                               {0.04, 0.62},
                                               {0.07, 0.76},
                                               {0.07, 0.82}});
  }
}

// The outer wall: closed below, with a round window in front of every arch above.
void build_wall(Masonry& m, const Side& side) {
  const double length = kBay * side.bays;
  const Frame f = side.frame.moved(0, 0, -kGallery - kWall / 2);
  const double sill = kFloor[1] + 1;
  const double end =
      kGallery + (side.bays == kLong ? kWall : 0);  // the long walls hold the corners
  m.block(f, {-end, -0.5, -kWall / 2}, {length + end, sill, kWall / 2});
  const Arch window{kBay, 0.6, kFloor[2] - sill - 1.4, kFloor[2] - sill, kWall};
  for (int bay = 0; bay < side.bays; ++bay) {
    const Frame g = f.moved(kBay * bay, sill, 0);
    m.arch(g, window);
    m.block(g, {0, 0, -kWall / 2}, {kBay / 2 - 0.6, window.spring, kWall / 2});
    m.block(g, {kBay / 2 + 0.6, 0, -kWall / 2}, {kBay, window.spring, kWall / 2});
  }
  for (const double a : {-end, length})
    m.block(f, {a, sill, -kWall / 2}, {a + end, kFloor[2], kWall / 2});
}

// Tiles in rows down the roof of a gallery, towards the court; mitred at the corners.
void build_roof(Masonry& m, const Side& side, std::vector<Patch>& roofs) {
  const double length = kBay * side.bays, run = kGallery + 1;
  const Frame f = side.frame.moved(0, kFloor[2] + 0.1, 0);
  const auto surface = [=](double u, double v) {
    const double out = 0.5 - run * v;  // also where the mitre is: the outer edge is longer
    const double a = out + (length - 2 * out) * u;
    const double wave = sin_turns(2 * a);
    return f.at(a, 1.4 * v + 0.07 * wave * wave, out);
  };
  roofs.push_back({surface, 2 * length, run, uint32_t(side.bays) * 24, 1, "roof", "roof"});
  m.block(f, {-kGallery - 0.3, -0.1, -kGallery - kWall}, {length + kGallery + 0.3, 0, -kGallery});
}

void furnish(Masonry& m, const Side& side, uint64_t seed) {
  for (int bay = 0; bay < side.bays; ++bay) {
    const uint64_t own = hash(seed, uint64_t(bay));
    const char* const cloth = bay % 4 == 1 ? "red cloth" : "blue cloth";
    m.part(cloth, cloth);
    if (bay % 2 == 1)
      m.curtain(side.frame.moved(kBay * bay + 0.35, kFloor[1] - 1, -0.45), kBay - 0.7, 3.3, own);
    if (bay % 3 == 1)
      m.curtain(side.frame.moved(kBay * bay + 0.8, kFloor[2] - 0.4, 0.45), 1.4, 4.2, own + 1);
    if (bay % 2 == 0) m.plant(side.frame.moved(kBay * bay + kBay / 2, 0.015, 0.9), own + 2);
  }
}

}  // namespace

std::unique_ptr<Mesh> make_atrium(uint64_t triangles, uint64_t seed) {
  Masonry m;
  std::vector<Patch> roofs;
  build_floor(m);
  for (size_t i = 0; i < 4; ++i) {
    m.part("stone", "limestone");
    build_arcade(m, kSides[i], 0);
    build_arcade(m, kSides[i], 1);
    m.part("plaster", "brick");
    build_wall(m, kSides[i]);
    m.part("stone", "limestone");
    build_roof(m, kSides[i], roofs);
    furnish(m, kSides[i], hash(seed, i));
  }
  m.part("stone", "limestone");
  for (const double x : {-kX - kGallery, kX}) {  // the galleries' corners
    for (const double z : {-kZ - kGallery, kZ}) {
      for (const double floor : {kFloor[1], kFloor[2]})
        m.block({}, {x - 0.3, floor - 0.35, z - 0.3},
                {x + kGallery + 0.3, floor, z + kGallery + 0.3});
    }
  }
  std::vector<Patch> patches = m.take();
  patches.insert(patches.end(), roofs.begin(), roofs.end());
  return std::make_unique<PatchMesh>(std::move(patches), triangles);
}

}  // namespace svdag::scenes
