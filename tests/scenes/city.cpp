// City: one house per lot on a square of lots, on a ground plate; 12 triangles each.
#include <algorithm>

#include "tests/scenes/kinds.h"
#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

constexpr double kExtent = 96, kTallest = 120;

// Corners are numbered by bits x, y, z = 4, 2, 1; two triangles per side, turned outwards.
constexpr uint8_t kBoxFaces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5},
                                      {0, 4, 5}, {0, 5, 1}, {2, 3, 7}, {2, 7, 6},
                                      {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};

class City : public Mesh {
 public:
  City(uint64_t boxes, uint64_t seed) : boxes_(boxes), seed_(seed) {
    while (side_ * side_ < boxes_ - 1) ++side_;
  }

  uint64_t vertices() const override { return 8 * boxes_; }
  uint64_t faces() const override { return 12 * boxes_; }

  Point vertex(uint64_t i) const override {
    const auto [low, high] = box(i / 8);
    return {i & 4 ? high.x : low.x, i & 2 ? high.y : low.y, i & 1 ? high.z : low.z};
  }

  std::string part(uint64_t i) const override {
    return i < 12 ? "ground" : "house " + std::to_string(i / 12);
  }

  Face face(uint64_t i) const override {
    const uint64_t base = i / 12 * 8;
    const uint8_t* corner = kBoxFaces[i % 12];
    return {base + corner[0], base + corner[1], base + corner[2]};
  }

 private:
  struct Corners {
    Point low, high;
  };
  // Box 0 is the ground; the others stand a little into it.
  Corners box(uint64_t i) const {
    const double edge = kExtent / 2;
    if (i == 0) return {{-edge, -1, -edge}, {edge, 0, edge}};
    const double lot = kExtent / double(side_);
    const double x = -edge + lot * double((i - 1) % side_);
    const double z = -edge + lot * double((i - 1) / side_);
    const double width = lot * (0.4 + 0.4 * uniform(seed_, 3 * i));
    const double depth = lot * (0.4 + 0.4 * uniform(seed_, 3 * i + 1));
    // Many low houses, few towers.
    const double rank = uniform(seed_, 3 * i + 2);
    const double height = std::min(lot * 0.4 / (0.1 + rank), kTallest);
    return {{x + 0.1 * lot, -0.125, z + 0.1 * lot},
            {x + 0.1 * lot + width, height, z + 0.1 * lot + depth}};
  }

  uint64_t boxes_;
  uint64_t seed_;
  uint64_t side_ = 1;  // lots on a side
};

}  // namespace

std::unique_ptr<Mesh> make_city(uint64_t triangles, uint64_t seed) {
  return std::make_unique<City>(std::max<uint64_t>(1, triangles / 12), seed);
}

}  // namespace svdag::scenes
