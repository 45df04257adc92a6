#include "io/dag/open_dag.h"

#include <cstring>

#include "io/dag/graph/select.h"
#include "io/dag/pack/unpack.h"
#include "streaming/error.h"
#include "streaming/process/executor.h"

namespace svdag {

bool begins_as_dag(const std::string& path) {
  if (is_packed(path)) return true;
  try {
    unsigned char magic[sizeof kMagic];
    const File file = File::open_read(path);
    return file.read_some_at(0, std::as_writable_bytes(std::span(magic))) == sizeof magic &&
           std::memcmp(magic, kMagic, sizeof magic) == 0;
  } catch (const Error&) {
    return false;  // opening it reports why
  }
}

DagFile open_dag(const std::string& path, const Selection& selection, const WorkRoom* room) {
  const bool packed = is_packed(path);
  if (!packed && selection.is_everything()) return DagFile::open(path);
  MemoryBudget budget(memory_or_default(0));
  const WorkRoom own = room != nullptr ? *room : temporary_room(&budget);
  ParallelExecutor executor(available_processors());
  DagFile file = packed ? unpack(path, own, &executor) : DagFile::open(path);
  return selection.is_everything() ? std::move(file) : derive(file, selection, own, &executor);
}

}  // namespace svdag
