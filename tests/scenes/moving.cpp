#include "tests/scenes/moving.h"

#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

constexpr double kFieldExtent = 64;  // |y| of most kinds is less
constexpr double kSway = 4;          // the largest move
constexpr double kTop = 42.5;        // a tenth of the vertices of the default scan are above it

}  // namespace

Point MovingMesh::vertex(uint64_t i) const {
  Point p = mesh_.vertex(i);
  const double above = p.y - kTop;
  if (moving_ == MovingPart::kTenth && above <= 0) return p;
  const double share = moving_ == MovingPart::kAll ? 1 : above / (above + 2);
  p.x += kSway * share * sin_turns(time_ + p.y / (4 * kFieldExtent));
  p.z += kSway * share * cos_turns(time_ + p.y / (4 * kFieldExtent));
  return p;
}

}  // namespace svdag::scenes
