// Messages for scene formats that svdag does not read: the format's name and a way to convert it.
#pragma once

#include <string>
#include <string_view>

namespace svdag {

// The sentence for a file with this lower-case extension that starts with `start`; empty if the
// format is not known.
std::string foreign_format_message(std::string_view extension, std::string_view start);

}  // namespace svdag
