#include "builder/commands/commands.h"
#include "streaming/error.h"
namespace svdag {
void info_scene(const InfoConfig& config) {
  fail_input(config.paths.front(), "TEMP");
}
}  // namespace svdag
