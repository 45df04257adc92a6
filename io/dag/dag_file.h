// A `.svdag` file mapped for reading. Header and structure are validated with pread before the file
// is mapped, so code that walks the view needs no checks.
#pragma once

#include <span>
#include <string>

#include "io/dag/dag_view.h"
#include "io/dag/layers/layer_index.h"
#include "io/dag/layers/layer_table.h"
#include "io/dag/layers/root_views.h"
#include "io/grid.h"
#include "streaming/file/mapped_file.h"

namespace svdag {

class DagFile {
 public:
  // Error (kBadInput) with path and offset if the file violates docs/format.md: magic, version,
  // sizes, checksums, references. Order and minimality are not checked
  // (verify/integrity/integrity.h does).
  static DagFile open(const std::string& path);

  // Maps a file that is known to be valid. Errors show `path`.
  static DagFile map_valid(File file, std::string path);

  const std::string& path() const { return path_; }
  const Header& header() const { return *static_cast<const Header*>(file_.data()); }
  const DagView& view() const { return view_; }
  Layout layout() const { return view_.layout; }
  // io/dag/colours/dag_colours.h looks them up.
  bool has_colours() const { return svdag::has_colours(header()); }
  // The whole file.
  std::span<const std::byte> bytes() const {
    return {static_cast<const std::byte*>(file_.data()), size_t(header().file_bytes)};
  }
  // Empty in a file without layers.
  const LayerTable& layers() const { return layers_; }
  // The index in level 0 of view() of a root of the table; kNoChild for kNoRoot.
  uint32_t root_node(uint32_t root) const {
    return root == kNoRoot ? kNoChild : roots_.index_of(root);
  }
  // The view of layer `layer` of the table; empty if it has no voxels. The file must outlive it.
  DagView view_of(size_t layer) const { return roots_.of(view_, layers_.layers[layer].root); }
  LayerIndex layer_index() const;
  Grid grid() const;
  Rule rule() const { return Rule(header().rule); }
  std::string_view metadata() const;  // the JSON text

 private:
  DagFile(MappedFile file, std::string path, LayerTable layers);

  std::string path_;
  MappedFile file_;
  DagView view_;
  LayerTable layers_;
  RootViews roots_;  // with layers
};

// The grid that a header describes.
Grid grid_of(const Header& header);

}  // namespace svdag
