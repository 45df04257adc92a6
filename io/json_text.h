// The text of a JSON value that this program made. File names and messages about their content may
// hold any bytes; those that are not valid UTF-8 become U+FFFD, because a report with a wrong
// letter is better than none.
#pragma once

#include <string>

namespace svdag {

// `Json` is one of nlohmann's, which only few files may name.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace svdag
