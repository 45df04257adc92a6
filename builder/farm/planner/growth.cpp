#include "builder/farm/planner/growth.h"

#include <algorithm>
#include <cmath>

namespace svdag {

double PowerLaw::operator()(double x) const {
  return x > 0 ? fine * std::pow(x / coarse, exponent) : 0;
}

PowerLaw power_law(double quarter_x, double quarter_y, double x, double y) {
  constexpr double kMinRatio = 1.2;  // of the two points
  if (x <= 0 || y <= 0) return {};
  PowerLaw law = {x, y, 1};
  if (quarter_x > 0 && quarter_y > 0 && x > kMinRatio * quarter_x)
    law.exponent = std::clamp(std::log(y / quarter_y) / std::log(x / quarter_x), 0.0, 1.0);
  return law;
}

Growth::Growth(const std::vector<DrawnCell>& drawn) : sums_{0} {
  for (const auto& [cell, growth, times] : drawn) {
    for (int i = 0; i < times; ++i) {
      cells_.push_back(cell);
      sums_.push_back(sums_.back() + growth);
    }
  }
}

double Growth::at(uint64_t cell) const {
  const size_t near = std::min(kNeighbours, cells_.size());
  if (near == 0) return 1;
  const size_t after =
      size_t(std::lower_bound(cells_.begin(), cells_.end(), cell) - cells_.begin());
  const size_t begin = std::min(after > near / 2 ? after - near / 2 : 0, cells_.size() - near);
  return (sums_[begin + near] - sums_[begin]) / double(near);
}

}  // namespace svdag
