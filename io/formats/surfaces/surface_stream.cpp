#include "io/formats/surfaces/surface_stream.h"

#include <algorithm>

#include "io/units.h"
#include "streaming/error.h"

namespace svdag {

SurfaceCounts stream_surface(const VoxelWindow& window, const SurfaceFileConfig& config,
                             const SurfaceSink& write) {
  uint64_t quads = 0;
  const SurfaceCounts counts = visit_surface(window, config.surface, [&](const SurfaceTile& tile) {
    quads += tile.quads.size();
    if (quads <= config.max_quads) write(tile);
  });
  if (counts.quads > config.max_quads)
    fail_usage("the surface has " + format_count(counts.quads) + " quads, more than " +
               format_count(config.max_quads) +
               ": export a coarser --level, a part with --bounds, or raise --max-quads");
  return counts;
}

void fail_too_large(const std::string& path, const char* limit) {
  fail_usage(path + ": the surface does not fit: " + limit +
             ": export a coarser --level, or parts with --bounds");
}

void LaterBytes::flush() {
  file_.write_at(written_, buffer_);
  written_ += buffer_.size();
  buffer_.clear();
}

void LaterBytes::append_to(Output* out) {
  flush();
  std::vector<std::byte> block(kBuffer);
  for (uint64_t at = 0; at < written_; at += block.size()) {
    const auto part = std::span(block).first(size_t(std::min<uint64_t>(kBuffer, written_ - at)));
    file_.read_at(at, part);
    out->put(part);
  }
}

}  // namespace svdag
