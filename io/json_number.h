// Checked reading of integers from JSON. nlohmann's library converts any number: 1e24 to an
// integer, which is undefined behaviour, and 2^32 + 11 to the int 11.
#pragma once

#include <cstdint>
#include <utility>

#include "streaming/error.h"

namespace svdag {

// Returns `json` as a T; Error (kBadInput) if it is not an integer in the range of T. `Json` is a
// nlohmann type, a parameter so that this header does not include the library.
template <class T, class Json>
T whole_number(const Json& json) {
  if (json.is_number_unsigned()) {
    const auto value = json.template get<uint64_t>();
    if (std::in_range<T>(value)) return T(value);
  } else if (json.is_number_integer()) {
    const auto value = json.template get<int64_t>();
    if (std::in_range<T>(value)) return T(value);
  }
  throw Error(ExitCode::kBadInput, "a number is not an integer or is out of range");
}

}  // namespace svdag
