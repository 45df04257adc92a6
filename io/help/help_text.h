// Formats a manual as the text of --help, for the width of a terminal.
#pragma once

#include "io/help/manual.h"

namespace svdag {

// Lines have at most `width` columns, except for longer words and sample output. A longer command
// line of an example is continued with a backslash. The texts of options are in a column beside
// their names if the width allows, else below them.
std::string help_text(const Manual& manual, size_t width);

// Formats a help topic, or the notes of a manual, in the same way.
std::string fill_paragraphs(std::string_view text, size_t width);

}  // namespace svdag
