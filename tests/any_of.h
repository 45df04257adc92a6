// A rapidcheck generator of uniformly distributed numbers.
//
// rapidcheck's inRange() enlarges its range with the number of the case, 0 to 100: high values come
// late, and the last value of a list of thirty is never drawn.
#pragma once

#include <rapidcheck.h>

namespace svdag {

// Numbers from `min` to `max` - 1.
template <class T>
rc::Gen<T> any_of(T min, T max) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<T>(min, max));
}

}  // namespace svdag
