// Names that strangers gave, for a terminal.
#pragma once

#include <string>

namespace svdag {

// `text` with '?' for what a terminal would obey: the control characters C0, DEL, and C1, which is
// U+0080 ... U+009F in UTF-8.
std::string printable(std::string text);

}  // namespace svdag
