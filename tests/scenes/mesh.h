// A mesh given by index: vertex(i) and face(i) are pure functions, so that a mesh of any size is
// written without being held, in any order, and comes out the same on every machine.
//
// World: y is up, lengths fit |x| < 128. Coordinates are rounded to multiples of 2^-16 when they
// are written (ply_writer.h), so that float and double files hold the same geometry.
// Rejected: generators that emit triangles (cannot be shuffled without holding them).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "io/triangle.h"

namespace svdag::scenes {

using Face = std::array<uint64_t, 3>;

// A point of a surface in two charts of textures.
struct Charts {
  std::array<double, 2> whole{};  // [0, 1]^2 over a surface, or a quarter of it in an atlas
  std::array<double, 2> along{};  // metres along the surface, for textures that repeat
};

struct Rig;  // tests/scenes/rig.h
// A vertex moves with two joints.
struct Grip {
  size_t joint = 0, other = 0;
  double share = 0;  // of the other joint
};

class Mesh {
 public:
  virtual ~Mesh() = default;
  virtual uint64_t vertices() const = 0;
  virtual uint64_t faces() const = 0;
  virtual Point vertex(uint64_t i) const = 0;  // i < vertices()
  virtual Face face(uint64_t i) const = 0;     // i < faces(); three different vertices
  // The part of the scene that face i belongs to, such as "roof".
  virtual std::string part(uint64_t) const { return "surface"; }
  // Its material, one of tests/scenes/materials.h if the scene has any.
  virtual std::string material(uint64_t i) const { return part(i); }
  virtual Charts charts(uint64_t) const { return {}; }  // of vertex i
  virtual const Rig* rig() const { return nullptr; }    // of a scene that is animated
  virtual Grip grip(uint64_t) const { return {}; }      // of vertex i, if there is a rig
};

// Face i of a grid of quads, `columns` quads in a row, vertices numbered row by row from 0. Each
// quad gives two faces that share the diagonal from its lower left to its upper right corner.
inline Face quad_face(uint64_t columns, uint64_t i) {
  const uint64_t quad = i / 2, row = quad / columns, column = quad % columns;
  const uint64_t a = row * (columns + 1) + column, b = a + columns + 1;
  return i % 2 == 0 ? Face{a, a + 1, b + 1} : Face{a, b + 1, b};
}

}  // namespace svdag::scenes
