#include "io/dag/dag_file.h"

#include <utility>

#include "io/dag/check.h"
#include "io/dag/colours/colours_check.h"
#include "io/dag/compact/compact_check.h"
#include "io/dag/grid_fields.h"

namespace svdag {

namespace {

// `data`: a whole file, whose header is valid.
LayerTable layers_of(const std::string& path, const void* data) {
  const Header& h = *static_cast<const Header*>(data);
  const auto* bytes = static_cast<const std::byte*>(data) + h.layers_offset;
  auto table = decode_layers(h, {bytes, size_t(h.layers_bytes)});
  if (!table) fail_input(path, "damaged file: an impossible layer table", h.layers_offset);
  return std::move(*table);
}

}  // namespace

DagFile DagFile::open(const std::string& path) {
  File file = File::open_read(path);
  const FileState before = state_of(file);
  const Header header = check_dag(file);
  MappedFile mapped(std::move(file), size_t(header.file_bytes), before);
  if (Layout(header.layout) == Layout::kCompact) {
    if (const auto defect = CompactCheck(mapped.data()).run())
      fail_input(path, std::string("damaged file: ") + defect->sentence, defect->offset);
  }
  if (const auto defect = colours_defect(mapped.data()))
    fail_input(path, std::string("damaged file: ") + defect->sentence, defect->offset);
  LayerTable layers = layers_of(path, mapped.data());
  return {std::move(mapped), path, std::move(layers)};
}

DagFile DagFile::map_valid(File file, std::string path) {
  const uint64_t size = file.size();
  const FileState state = state_of(file);
  MappedFile mapped(std::move(file), size, state);
  LayerTable layers = layers_of(path, mapped.data());
  return {std::move(mapped), std::move(path), std::move(layers)};
}

DagFile::DagFile(MappedFile file, std::string path, LayerTable layers)
    : path_(std::move(path)),
      file_(std::move(file)),
      view_(dag_view(file_.data())),
      layers_(std::move(layers)) {
  if (!layers_.empty()) roots_ = RootViews(view_);
}

LayerIndex DagFile::layer_index() const {
  return {view_.levels, layers_.layers.size(), [this](size_t layer) { return view_of(layer); }};
}

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
