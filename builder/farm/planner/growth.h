// Growth of counts from a coarse survey to the grid's own level, estimated from a sample.
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

// Through (quarter_x, quarter_y) and (x, y). The exponent is between 0 and 1, for finer voxels
// repeat themselves no less; 1 where the points are too near to each other to tell. Without a
// sample: y = x.
PowerLaw power_law(double quarter_x, double quarter_y, double x, double y);

// How much more the cells of a scene cost at the grid's level than in the coarse survey.
class Growth {
 public:
  // A cell that was drawn so many times.
  struct Drawn {
    uint64_t cell;
    double growth;
    int times;
  };

  // `drawn` in the order of cells. Without any, nothing grows.
  explicit Growth(const std::vector<Drawn>& drawn = {});

  // The mean of the kNear drawings nearest to `cell`, half of them on either side if there are.
  double at(uint64_t cell) const;

  static constexpr size_t kNear = 8;

 private:
  std::vector<uint64_t> cells_;  // of each drawing
  std::vector<double> sums_;     // of their growths: of none, of one, of two ...
};

}  // namespace svdag
