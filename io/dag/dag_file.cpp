#include "io/dag/dag_file.h"

#include <utility>

#include "io/dag/check.h"
#include "io/dag/compact_check.h"
#include "io/dag/grid_fields.h"

namespace svdag {

DagFile DagFile::open(const std::string& path) {
  File file = File::open_read(path);
  const FileState before = state_of(file);
  const Header header = check_dag(file);
  MappedFile mapped(std::move(file), size_t(header.file_bytes), before);
  if (Layout(header.layout) == Layout::kCompact) {
    if (const auto defect = CompactCheck(mapped.data()).run())
      fail_input(path, std::string("damaged file: ") + defect->sentence, defect->offset);
  }
  return {std::move(mapped), path};
}

DagFile DagFile::adopt(File file, std::string path) {
  const uint64_t size = file.size();
  const FileState state = state_of(file);
  return {MappedFile(std::move(file), size, state), std::move(path)};
}

DagFile::DagFile(MappedFile file, std::string path)
    : path_(std::move(path)), file_(std::move(file)), view_(dag_view(file_.data())) {}

Grid DagFile::grid() const {
  return grid_of(header());
}

std::string_view DagFile::metadata() const {
  return {static_cast<const char*>(file_.data()) + header().metadata_offset,
          size_t(header().metadata_bytes)};
}

Grid grid_of(const Header& header) {
  const bool box = header.grid_kind == uint32_t(Grid::Kind::kBox);
  return get_grid(header, box ? header.corner : header.origin);
}

}  // namespace svdag
