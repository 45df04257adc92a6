#include "builder/commands/farm/disk_check.h"

#include <cstdio>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file_folder.h"
#include "streaming/printable.h"

namespace svdag {

void check_disk(const std::string& folder, uint64_t bytes, const std::string& who) {
  const uint64_t free = free_bytes_of(folder);
  if (bytes <= free) return;
  const std::string need = who + " is predicted to write about " + format_bytes(bytes) +
                           " here, and only " + format_bytes(free) + " is free";
  if (bytes / 2 > free) throw Error(ExitCode::kOutput, need + ": free disk space first", folder);
  std::fprintf(stderr, "svdag: %s: warning: %s\n", printable(folder).c_str(), need.c_str());
}

}  // namespace svdag
