// The terminal behind a stream: how wide it is, and whether a line on it can be drawn again.
#pragma once

#include <cstddef>
#include <cstdio>

namespace svdag {

// Columns for text: COLUMNS if set, else the terminal's, else 80; at least 40, and at most 100,
// beyond which lines are hard to read.
size_t text_width(std::FILE* stream);

// Columns of a line that is drawn again and again: those of the terminal; 80 if it does not tell.
size_t line_width(std::FILE* stream);

// A terminal that moves its cursor; TERM=dumb says that it does not.
bool is_lively(std::FILE* stream);

}  // namespace svdag
