// Prints a JSON value of this program. File names, and messages about file contents, may hold any
// bytes: invalid UTF-8 becomes U+FFFD, since a report with a wrong character is better than none.
#pragma once

#include <string>

namespace svdag {

// `Json` is a nlohmann type, a parameter so that this header does not include the library.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace svdag
