// A number of a range, each as likely as any other.
//
// rapidcheck's inRange grows its range with the number of the case, 0 to 100: the upper end comes
// late, and the last value of a list of thirty is never drawn.
#pragma once

#include <rapidcheck.h>

namespace svdag {

// `min` .. `max` - 1.
template <class T>
rc::Gen<T> any_of(T min, T max) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<T>(min, max));
}

}  // namespace svdag
