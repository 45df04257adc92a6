// RapidCheck generators for the types of io/.
#pragma once

#include <rapidcheck.h>

#include <cmath>

#include "io/grid.h"
#include "tests/any_of.h"

namespace svdag {

// Coordinates of both signs: multiples of 1/4, and numbers of any magnitude.
inline rc::Gen<double> coordinates() {
  return rc::gen::map(rc::gen::tuple(any_of<int64_t>(-1'000'000, 1'000'000), any_of(-30, 10),
                                     rc::gen::arbitrary<bool>()),
                      [](const std::tuple<int64_t, int, bool>& t) {
                        const auto [mantissa, exponent, round] = t;
                        return round ? double(mantissa % 1000) / 4
                                     : std::ldexp(double(mantissa) / 7, exponent);
                      });
}

inline rc::Gen<Point> points() {
  return rc::gen::map(rc::gen::tuple(coordinates(), coordinates(), coordinates()),
                      [](const std::tuple<double, double, double>& t) {
                        return Point(std::get<0>(t), std::get<1>(t), std::get<2>(t));
                      });
}

// The box of two points, with an extent on at least one axis.
inline rc::Gen<Box> boxes() {
  return rc::gen::suchThat(rc::gen::map(rc::gen::pair(points(), points()),
                                        [](const std::pair<Point, Point>& p) {
                                          Box box;
                                          box.add(p.first);
                                          box.add(p.second);
                                          return box;
                                        }),
                           [](const Box& b) { return b.min != b.max; });
}

inline rc::Gen<int> level_counts() {
  return any_of(kMinLevels, kMaxLevels + 1);
}

}  // namespace svdag
