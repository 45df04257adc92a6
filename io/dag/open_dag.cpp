#include "io/dag/open_dag.h"

#include "io/dag/graph/select.h"
#include "io/dag/pack/unpack.h"
#include "streaming/process/executor.h"

namespace svdag {

bool begins_as_dag(const std::string& path) {
  return begins_with(kMagic, path) || is_packed(path);
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
