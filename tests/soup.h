// Triangle soups for tests: made in memory, written as binary STL where a file is needed.
#pragma once

#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "io/triangle.h"

namespace svdag {

inline void write_stl(const std::string& path, const std::vector<Triangle>& triangles) {
  std::ofstream out(path, std::ios::binary);
  const uint32_t count = uint32_t(triangles.size());
  out << std::string(80, ' ');
  out.write(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& t : triangles) {
    float values[12] = {};
    for (int i = 0; i < 9; ++i) values[3 + i] = float(t.v[size_t(i / 3)][i % 3]);
    out.write(reinterpret_cast<const char*>(values), 48);
    out.write("\0\0", 2);
  }
}

inline std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// `count` triangles of size about `size` with corners in the unit cube; portable random numbers.
inline std::vector<Triangle> random_soup(size_t count, double size, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<Triangle> soup(count);
  for (Triangle& t : soup) {
    const Point centre(unit(), unit(), unit());
    for (Point& p : t.v) p = centre + size * Point(unit() - 0.5, unit() - 0.5, unit() - 0.5);
  }
  return soup;
}

// A sphere of 2 * stacks * stacks triangles with bumps.
inline std::vector<Triangle> bumpy_sphere(int stacks) {
  const auto at = [&](int i, int j) {
    const double theta = M_PI * i / stacks, phi = M_PI * (j % (2 * stacks)) / stacks;
    const double r = 1 + 0.1 * std::sin(5 * theta) * std::cos(4 * phi);
    return Point(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                 r * std::cos(theta));
  };
  std::vector<Triangle> mesh;
  for (int i = 0; i < stacks; ++i) {
    for (int j = 0; j < 2 * stacks; ++j) {
      mesh.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      mesh.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return mesh;
}

// The twelve triangles of a box, two for each face, with their front outside.
inline std::vector<Triangle> closed_box(const Point& low, const Point& high) {
  std::vector<Triangle> mesh;
  for (int w = 0; w < 3; ++w) {
    Point u(0), v(0), up(0);
    u[(w + 1) % 3] = (high - low)[(w + 1) % 3];
    v[(w + 2) % 3] = (high - low)[(w + 2) % 3];
    up[w] = (high - low)[w];
    mesh.push_back({{low + up, low + up + u, low + up + u + v}});
    mesh.push_back({{low + up, low + up + u + v, low + up + v}});
    mesh.push_back({{low, low + u + v, low + u}});
    mesh.push_back({{low, low + v, low + u + v}});
  }
  return mesh;
}

// Axis-aligned boxes and a big slanted quad: large triangles that stay at inner nodes.
inline std::vector<Triangle> boxes_and_quad(int boxes, uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
  std::vector<Triangle> mesh = {{{Point(0, 0, 0), Point(1, 0, 0.3), Point(1, 1, 0.9)}},
                                {{Point(0, 0, 0), Point(1, 1, 0.9), Point(0, 1, 0.6)}}};
  static constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  for (int b = 0; b < boxes; ++b) {
    const Point low(unit(), unit(), unit()), size = 0.05 + 0.15 * Point(unit(), unit(), unit());
    Point p[8];
    for (int i = 0; i < 8; ++i)
      p[i] = low + Point(i & 4 ? size.x : 0, i & 2 ? size.y : 0, i & 1 ? size.z : 0);
    for (const auto& f : kFaces) {
      mesh.push_back({{p[f[0]], p[f[1]], p[f[2]]}});
      mesh.push_back({{p[f[0]], p[f[2]], p[f[3]]}});
    }
  }
  return mesh;
}

}  // namespace svdag
