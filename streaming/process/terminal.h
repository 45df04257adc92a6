// Properties of the terminal behind a stream: its width, and whether a line can be redrawn.
#pragma once

#include <cstddef>
#include <cstdio>

namespace svdag {

// Columns for text: $COLUMNS if set, else the terminal's width, else 80; clamped to 40 .. 100,
// since longer lines are hard to read.
size_t text_width(std::FILE* stream);

// Columns for a line that is redrawn: the terminal's width, or 80 if it is unknown.
size_t line_width(std::FILE* stream);

// True if `stream` is a terminal that can move its cursor: not one with TERM=dumb.
bool can_redraw(std::FILE* stream);

}  // namespace svdag
