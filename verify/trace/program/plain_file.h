// A `.svdag` in memory, read without any third-party library.
//
// For svdag-trace alone. Sizes and every pointer are proven in one pass over the sections, as
// docs/format.md says them, so a tracer may trust the view; checksums are not looked at (they need
// xxHash; svdag-verify check proves them), so a file that was written meanwhile is known by its
// time.
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

// A file that cannot be read, is damaged, or was written while it was read is an Error (kBadInput);
// one of more than `room` bytes one of kMemory.
PlainFile read_plain_file(const std::string& path, uint64_t room = UINT64_MAX);

}  // namespace svdag
