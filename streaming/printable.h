// Makes untrusted text safe to print on a terminal.
#pragma once

#include <string>

namespace svdag {

// Returns `text` with '?' in place of each control character: C0, DEL, and C1 (U+0080 to U+009F in
// UTF-8).
std::string printable(std::string text);

}  // namespace svdag
