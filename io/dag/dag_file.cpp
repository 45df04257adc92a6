#include "io/dag/dag_file.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "io/dag/check.h"
#include "io/dag/compact_check.h"
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
  LayerTable layers = layers_of(path, mapped.data());
  return {std::move(mapped), path, std::move(layers)};
}

DagFile DagFile::adopt(File file, std::string path) {
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
  if (layers_.empty()) return;
  for (uint64_t index = 0; index < view_.index_end[0]; index = dag_next(view_, 0, index)) {
    root_index_.push_back(uint32_t(index));
    if (layout() == Layout::kCompact)
      root_lines_.push_back(root_line(view_.compact[0], uint32_t(index)));
  }
}

// A node's references are counted from the bases of its line, so the line of a node alone has its
// two bytes, and as bases the references to each class before it.
DagFile::RootLine DagFile::root_line(const CompactLevel& level, uint32_t node) {
  RootLine root;
  const auto* const line =
      reinterpret_cast<const unsigned char*>(level.lines + node / kLineNodes * 8);
  std::copy_n(level.bases + node / kLineNodes * kClasses, kClasses, root.bases);
  for (uint32_t i = 0; i < node % kLineNodes; ++i) {
    const unsigned m0 = line[i], m1 = line[kLineNodes + i];
    root.bases[0] += uint32_t(std::popcount(m0 & ~m1));
    root.bases[1] += uint32_t(std::popcount(~m0 & m1));
    root.bases[2] += uint32_t(std::popcount(m0 & m1));
  }
  root.line[0] = line[node % kLineNodes];
  root.line[kLineNodes] = line[kLineNodes + node % kLineNodes];
  return root;
}

DagView DagFile::view_of(size_t layer) const {
  const uint32_t root = layers_.layers[layer].root;
  DagView view = view_;
  if (root == kNoRoot) {
    view.brick_count = 0;
    std::fill(std::begin(view.index_end), std::end(view.index_end), 0);
  } else if (layout() == Layout::kPlain) {
    view.words[0] += root_index_[root];
    view.index_end[0] = 1 + uint64_t(popcount8(view.words[0][0]));
  } else {
    view.compact[0].lines = reinterpret_cast<const uint64_t*>(root_lines_[root].line);
    view.compact[0].bases = root_lines_[root].bases;
    view.index_end[0] = 1;
  }
  return view;
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
