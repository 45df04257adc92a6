// Reading and printing JSON. The functions take nlohmann's type as a parameter, so this header does
// not include the library.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "streaming/error.h"

namespace svdag {

// Returns `json` as a T; Error (kBadInput) if it is not an integer in the range of T. nlohmann's
// library converts any number: 1e24 to an integer, which is undefined behaviour, and 2^32 + 11 to
// the int 11.
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

// Prints a JSON value of this program. File names, and messages about file contents, may hold any
// bytes: invalid UTF-8 becomes U+FFFD, since a report with a wrong character is better than none.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace svdag
