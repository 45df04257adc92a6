#include "io/dag/symvox_header.h"

#include <cmath>
#include <span>

#include "streaming/error.h"

namespace svdag {

bool read_symvox_header(const File& file, SymvoxHeader* header) {
  SymvoxHeader h;
  if (file.read_some_at(0, std::as_writable_bytes(std::span(&h, 1))) < sizeof h) return false;
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(h.box_min[a]) || !std::isfinite(h.box_max[a]) || h.box_min[a] > h.box_max[a])
      return false;
  }
  if (!std::isfinite(h.side) || h.side <= 0 || h.levels < 1 || h.levels > 32) return false;
  if (h.nodes == 0 || h.nodes > h.words || h.first_leaf > h.words) return false;
  if (file.size() != sizeof h + uint64_t(4) * h.words) return false;
  *header = h;
  return true;
}

void reject_symvox(const File& file) {
  SymvoxHeader header;
  if (read_symvox_header(file, &header))
    fail_input(file.path(), "is a SymVox .svdag: convert it with svdag import");
}

}  // namespace svdag
