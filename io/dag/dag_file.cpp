#include "io/dag/dag_file.h"

#include <sys/mman.h>

#include <utility>

#include "io/dag/check.h"
#include "io/dag/grid_fields.h"
#include "streaming/error.h"

namespace svdag {

DagFile DagFile::open(const std::string& path) {
  File file = File::open_read(path);
  const Header header = check_dag(file);
  const size_t size = size_t(header.file_bytes);
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor(), 0);
  if (data == MAP_FAILED) fail_input(path, "cannot be mapped into memory");
  return DagFile(std::move(file), data, size);
}

DagFile::DagFile(File file, void* data, size_t size)
    : file_(std::move(file)), data_(data), size_(size), view_(dag_view(data)) {}

DagFile::DagFile(DagFile&& other) noexcept
    : file_(std::move(other.file_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(other.size_),
      view_(other.view_) {}

DagFile::~DagFile() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

Grid DagFile::grid() const {
  return grid_of(header());
}

std::string_view DagFile::metadata() const {
  return {static_cast<const char*>(data_) + header().metadata_offset,
          size_t(header().metadata_bytes)};
}

Grid grid_of(const Header& header) {
  return get_grid(header, header.corner);
}

}  // namespace svdag
