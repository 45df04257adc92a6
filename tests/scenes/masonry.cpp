#include "tests/scenes/masonry.h"

#include <cmath>

namespace svdag::scenes {
namespace {

constexpr uint32_t kRound = 12;  // the fewest sides of anything round

Point lerp(const Point& a, const Point& b, double t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t};
}

}  // namespace

void Masonry::sheet(const Frame& f, const Point& p, const Point& u, const Point& v) {
  const auto surface = [=](double s, double t) {
    return f.at(p.x + u.x * s + v.x * t, p.y + u.y * s + v.y * t, p.z + u.z * s + v.z * t);
  };
  add(surface, length(u), length(v));
}

void Masonry::tile(const Frame& f, const Point& low, const Point& high) {
  const Point a{high.x - low.x, 0, 0}, y{0, high.y - low.y, 0}, c{0, 0, high.z - low.z};
  sheet(f, {low.x, high.y, low.z}, c, a);
  sheet(f, low, y, a);
  sheet(f, low, c, y);
  sheet(f, {low.x, low.y, high.z}, a, y);
  sheet(f, {high.x, low.y, low.z}, y, c);
}

void Masonry::block(const Frame& f, const Point& low, const Point& high) {
  tile(f, low, high);
  sheet(f, low, {high.x - low.x, 0, 0}, {0, 0, high.z - low.z});
}

void Masonry::turned(const Frame& f, const Profile& profile, uint32_t cell) {
  const double pieces = double(profile.size() - 1);
  double widest = 0, height = 0;
  for (size_t i = 0; i < profile.size(); ++i) {
    widest = std::max(widest, profile[i].first);
    if (i > 0)
      height += length(
          {profile[i].first - profile[i - 1].first, profile[i].second - profile[i - 1].second, 0});
  }
  const auto surface = [=](double u, double v) {
    const size_t piece = std::min(size_t(v * pieces), profile.size() - 2);
    const double t = v * pieces - double(piece);
    const auto [r0, y0] = profile[piece];
    const auto [r1, y1] = profile[piece + 1];
    const double r = r0 + (r1 - r0) * t;
    return f.at(r * cos_turns(u), y0 + (y1 - y0) * t, -r * sin_turns(u));
  };
  // Three times as fine as what is flat, so that it looks round. Its texture repeats twice around.
  add_bent(surface, 3 * 6.28 * widest, height, kRound, uint32_t(pieces), 2).cell = cell;
}

// The wall between the arc and its frame, in three patches that meet in the frame's upper corners.
void Masonry::arch_face(const Frame& f, const Arch& arch, double c) {
  const double half = arch.width / 2, rise = arch.top - arch.spring;
  const Point corners[] = {{0, arch.spring, c},
                           {0, arch.top, c},
                           {arch.width, arch.top, c},
                           {arch.width, arch.spring, c}};
  constexpr double kTurns[] = {0.5, 0.375, 0.125, 0};
  for (int side = 0; side < 3; ++side) {
    const Point from = corners[side], to = corners[side + 1];
    const double begin = kTurns[side], end = kTurns[side + 1];
    const auto surface = [=](double u, double v) {
      const double t = c < 0 ? 1 - u : u;  // both faces turned outwards
      const double turn = begin + (end - begin) * t;
      const Point arc{half + arch.radius * cos_turns(turn),
                      arch.spring + arch.radius * sin_turns(turn), c};
      const Point p = lerp(arc, lerp(from, to, t), v);
      return f.at(p.x, p.y, p.z);
    };
    add(surface, side == 1 ? arch.width : rise, half - arch.radius, side == 1 ? 8 : 4);
  }
}

void Masonry::arch(const Frame& f, const Arch& arch) {
  const double half = arch.width / 2, c = arch.thickness / 2;
  arch_face(f, arch, c);
  arch_face(f, arch, -c);
  const double arc = 3.14 * arch.radius;
  const auto ring = [=](double turn, double radius, double depth) {
    return f.at(half + radius * cos_turns(turn), arch.spring + radius * sin_turns(turn), depth);
  };
  add_bent([=](double u, double v) { return ring(u / 2, arch.radius, (2 * v - 1) * c); }, arc,
           arch.thickness, 16, 1, arc);
  // The moulding: the front and the outer side of a ring that projects from the wall.
  const double outer = arch.radius + 0.16, front = c + 0.05;
  add([=](double u, double v) { return ring(u / 2, outer + (arch.radius - outer) * v, front); },
      arc, 0.16, 16);
  add([=](double u, double v) { return ring(u / 2, outer, c + (front - c) * v); }, arc, 0.05, 16);
  add([=](double u, double v) { return ring(u / 2, arch.radius, front + (c - front) * v); }, arc,
      0.05, 16);
  // The undersides beside the opening, where the wall rests on the columns.
  for (const double a : {0.0, half + arch.radius})
    sheet(f, {a, arch.spring, -c}, {half - arch.radius, 0, 0}, {0, 0, arch.thickness});
}

void Masonry::column(const Frame& f, double height, double radius) {
  const double wide = radius * 1.5;
  block(f, {-wide, 0, -wide}, {wide, 0.14, wide});
  const char* const wall = std::exchange(material_, "marble");
  turned(f, {{1.42 * radius, 0.14},
             {1.48 * radius, 0.18},
             {1.42 * radius, 0.24},
             {1.2 * radius, 0.27},
             {1.28 * radius, 0.31},
             {1.2 * radius, 0.35},
             {radius, 0.37}});
  const double shaft = height - 0.62;
  turned(f, {{radius, 0.37},
             {0.99 * radius, 0.37 + (shaft - 0.37) * 0.33},
             {0.95 * radius, 0.37 + (shaft - 0.37) * 0.67},
             {0.86 * radius, shaft}});
  material_ = "painted";
  turned(f,
         {{0.86 * radius, shaft},
          {radius, shaft + 0.03},
          {radius, shaft + 0.08},
          {0.88 * radius, shaft + 0.1},
          {0.95 * radius, shaft + 0.22},
          {1.15 * radius, shaft + 0.36},
          {1.42 * radius, shaft + 0.46}},
         4);
  material_ = wall;
  block(f, {-wide, height - 0.16, -wide}, {wide, height, wide});
}

void Masonry::curtain(const Frame& f, double width, double drop, uint64_t seed) {
  const double folds = 5, phase = uniform(seed, 0);
  const auto surface = [=](double u, double v) {
    const double open = 0.05 + 0.09 * v;
    const double turn = folds * u + phase + 0.15 * sin_turns(0.7 * v + phase);
    const double hem = 0.06 * sin_turns(2 * u + phase) * v;
    return f.at(width * (u + 0.02 * sin_turns(3 * u + v)), -(drop + hem) * v,
                open * sin_turns(turn) + 0.1 * noise(seed, {u * 3, v * 3, 0.5}) * v);
  };
  add_bent(surface, 3 * width, 1.5 * drop, 40, 10, 1.5 * width);
}

void Masonry::leaf(const Frame& f, double turn, double size) {
  const double dx = cos_turns(turn), dz = sin_turns(turn);
  const auto surface = [=](double u, double v) {
    const double along = size * v * (1 - 0.35 * v), up = size * (1.3 * v - v * v * 0.9);
    const double half = 0.16 * size * 4 * v * (1 - v) * (2 * u - 1);
    const double crease = 0.25 * std::abs(half);
    return f.at(dx * along - dz * half, up + crease, dz * along + dx * half);
  };
  add(surface, 0.3 * size, 1.5 * size, 2, 6);
}

void Masonry::plant(const Frame& f, uint64_t seed) {
  part("vase", "painted");
  turned(f,
         {{0, 0},
          {0.22, 0},
          {0.24, 0.05},
          {0.16, 0.1},
          {0.3, 0.28},
          {0.37, 0.45},
          {0.33, 0.6},
          {0.24, 0.68},
          {0.31, 0.74},
          {0.28, 0.74},
          {0.22, 0.68},
          {0, 0.66}},
         uint32_t(1 + seed % 3));
  part("leaves", "leaves");
  const Frame top = f.moved(0, 0.66, 0);
  for (uint64_t i = 0; i < 18; ++i)
    leaf(top, double(i) * 0.381966 + 0.05 * uniform(seed, 2 * i),
         0.7 + 0.6 * uniform(seed, 2 * i + 1));
}

}  // namespace svdag::scenes
