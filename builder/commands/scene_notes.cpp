#include "builder/commands/scene_notes.h"

#include <cstdio>

#include "io/units.h"
#include "streaming/printable.h"

namespace svdag {

void print_scene_notes(const SceneCounts& counts) {
  for (const std::string& pattern : counts.unmatched)
    std::printf("  no part of the scene matches %s\n", printable(pattern).c_str());
  for (const std::string& image : counts.unread_images)
    std::printf("  no colour from a texture: %s\n", printable(image).c_str());
  if (counts.undeformed > 0)
    std::printf("  %s triangles are read as stored: skins and morph targets are not applied\n",
                format_count(counts.undeformed).c_str());
}

}  // namespace svdag
