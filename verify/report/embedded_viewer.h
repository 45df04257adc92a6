// The viewer inside another page: scripts, scene and tiles as text, which needs no network.
#pragma once

#include <cstdint>
#include <string>

#include "streaming/process/executor.h"
#include "verify/view/page.h"

namespace svdag {

struct EmbeddedViewer {
  uint32_t level = 0;       // the finest that it shows; 0: no viewer
  std::string style;        // CSS
  std::string html;         // a <div> that is hidden until the script shows it, and the script
  std::string script_hash;  // for the page's policy: 'sha256-...'
};

// A viewer of the finest level, 3 .. L, whose tiles take at most about `max_bytes` of text. Without
// WebGL2 the <div> stays hidden.
EmbeddedViewer embed_viewer(const DagFile& file, int up, uint64_t max_bytes, Executor& executor);

}  // namespace svdag
