#include "io/dag/dag_file.h"

#include <utility>

#include "io/dag/check.h"
#include "io/dag/grid_fields.h"

namespace svdag {

DagFile DagFile::open(const std::string& path) {
  File file = File::open_read(path);
  const FileState before = state_of(file);
  const Header header = check_dag(file);
  return DagFile(MappedFile(std::move(file), size_t(header.file_bytes), before));
}

DagFile::DagFile(MappedFile file) : file_(std::move(file)), view_(dag_view(file_.data())) {}

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
