#include "builder/run/content_hash.h"

#include "builder/run/bake_output.h"
#include "builder/run/run_check.h"
#include "builder/run/run_file.h"
#include "io/dag/check.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

constexpr uint64_t kCheckMemory = uint64_t(64) << 20;

std::string hash_of_run(const std::string& path, bool thorough) {
  MemoryBudget budget;
  const RunFile run = RunFile::open(path, &budget);
  if (thorough) check_run(run, kCheckMemory, &budget);
  return to_hex(run.header().content_hash);
}

std::string hash_of_dag(const std::string& path, bool thorough) {
  const File file = File::open_read(path);
  Header header;
  if (thorough) {
    header = check_dag(file);
  } else {
    file.read_at(0, std::as_writable_bytes(std::span(&header, 1)));
    if (header.file_bytes != file.size()) fail_input(path, "is truncated");
  }
  const std::string hash = to_hex(header.content_hash);
  return has_colours(header) ? hash + "+" + to_hex(header.colour_hash) : hash;
}

}  // namespace

std::string content_hash_of(const std::string& path, bool thorough) {
  return names_run(path) ? hash_of_run(path, thorough) : hash_of_dag(path, thorough);
}

}  // namespace svdag
