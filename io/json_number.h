// Whole numbers of a JSON document. The library converts whatever number is there: a fraction or
// 1e24 to an integer, which is undefined behaviour, and 2^32 + 11 to the int 11.
#pragma once

#include <cstdint>
#include <utility>

#include "streaming/error.h"

namespace svdag {

// `json` as a T. Error (kBadInput) if it is not a whole number in the range of T. `Json` is one of
// nlohmann's types, which only few files may name.
template <class T, class Json>
T whole_number(const Json& json) {
  if (json.is_number_unsigned()) {
    const auto value = json.template get<uint64_t>();
    if (std::in_range<T>(value)) return T(value);
  } else if (json.is_number_integer()) {
    const auto value = json.template get<int64_t>();
    if (std::in_range<T>(value)) return T(value);
  }
  throw Error(ExitCode::kBadInput, "has a number that is not whole, or does not fit");
}

}  // namespace svdag
