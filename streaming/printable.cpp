#include "streaming/printable.h"

#include <cstdint>

namespace svdag {

std::string printable(std::string text) {
  size_t kept = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = uint8_t(text[i]);
    const bool c1 = c == 0xc2 && i + 1 < text.size() && (uint8_t(text[i + 1]) & 0xe0) == 0x80;
    text[kept++] = c < 0x20 || c == 0x7f || c1 ? '?' : text[i];
    if (c1) ++i;
  }
  text.resize(kept);
  return text;
}

}  // namespace svdag
