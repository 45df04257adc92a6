// Growth of counts from a coarse survey to the grid's level, estimated from a sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace svdag {

// y = fine (x / coarse)^exponent
struct PowerLaw {
  double coarse = 1, fine = 1, exponent = 1;

  double operator()(double x) const;
};

// The power law through (quarter_x, quarter_y) and (x, y). The exponent is clamped to [0, 1], since
// finer voxels repeat at least as much; it is 1 if the points are too close to determine it.
// Without a sample: y = x.
PowerLaw power_law(double quarter_x, double quarter_y, double x, double y);

// The ratio of a cell's cost at the grid's level to its cost in the coarse survey.
class Growth {
 public:
  // A cell of the sample, which was drawn `times` times.
  struct DrawnCell {
    uint64_t cell;
    double growth;
    int times;
  };

  // `drawn` must be sorted by cell. An empty sample gives growth 1.
  explicit Growth(const std::vector<DrawnCell>& drawn = {});

  // The mean of the kNeighbours draws nearest to `cell` in Morton order, half of them on either
  // side where possible.
  double at(uint64_t cell) const;

  static constexpr size_t kNeighbours = 8;

 private:
  std::vector<uint64_t> cells_;  // of each draw
  std::vector<double> sums_;     // prefix sums of their growths
};

}  // namespace svdag
