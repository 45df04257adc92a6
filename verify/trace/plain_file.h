// A `.svdag` in memory, read without any third-party library.
//
// For svdag-trace alone. Sizes and every pointer are proven in one pass over the sections, as
// docs/format.md says them, so a tracer may trust the view; checksums are not looked at (they need
// xxHash; svdag-verify check proves them).
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

struct PlainFile {
  std::vector<uint64_t> words;  // the file
  DagView view;

  const Header& header() const { return *reinterpret_cast<const Header*>(words.data()); }
  uint64_t bytes() const { return header().file_bytes; }
};

// A file that cannot be read, or is damaged, is an Error (kBadInput).
PlainFile read_plain_file(const std::string& path);

}  // namespace svdag
