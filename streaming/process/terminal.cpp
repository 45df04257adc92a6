#include "streaming/process/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace svdag {
namespace {

// Width of the terminal; 0 without a terminal, or if it is unknown.
size_t columns_of(std::FILE* stream) {
  struct winsize size = {};
  return ::ioctl(::fileno(stream), TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace

size_t text_width(std::FILE* stream) {
  const char* variable = std::getenv("COLUMNS");
  size_t columns = variable == nullptr ? 0 : std::strtoul(variable, nullptr, 10);
  if (columns == 0) columns = columns_of(stream);
  if (columns == 0) columns = 80;
  return std::clamp<size_t>(columns, 40, 100);
}

size_t line_width(std::FILE* stream) {
  const size_t columns = columns_of(stream);
  return columns == 0 ? 80 : columns;
}

bool can_redraw(std::FILE* stream) {
  const char* term = std::getenv("TERM");
  return ::isatty(::fileno(stream)) == 1 && !(term != nullptr && std::string_view(term) == "dumb");
}

}  // namespace svdag
