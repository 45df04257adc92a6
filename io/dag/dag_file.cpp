#include "io/dag/dag_file.h"

#include <utility>

#include "io/dag/check.h"
#include "io/dag/grid_fields.h"

namespace svdag {

DagFile DagFile::open(const std::string& path) {
  File file = File::open_read(path);
  const Header header = check_dag(file);
  MappedFile mapped(file, size_t(header.file_bytes));
  return DagFile(std::move(file), std::move(mapped));
}

DagFile::DagFile(File file, MappedFile mapped)
    : file_(std::move(file)), mapped_(std::move(mapped)), view_(dag_view(mapped_.data())) {}

Grid DagFile::grid() const {
  return grid_of(header());
}

std::string_view DagFile::metadata() const {
  return {static_cast<const char*>(mapped_.data()) + header().metadata_offset,
          size_t(header().metadata_bytes)};
}

Grid grid_of(const Header& header) {
  return get_grid(header, header.corner);
}

}  // namespace svdag
