// --help: a manual as text that fits a terminal.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// At most `width` columns, except for longer words and lines of output. A longer command line of an
// example continues in the next line, as a shell reads it. If the width allows, the texts of
// options are in a column beside their names, else below them.
std::string help_text(const Manual& manual, size_t width);

// A topic, or the notes of a manual, in the same way.
std::string filled(std::string_view text, size_t width);

// "-r, --resolution N": an option with all its names, or an operand.
std::string title_of(const ManualOption& option);

}  // namespace svdag
