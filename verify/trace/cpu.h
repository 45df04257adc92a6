// Renders pictures on the processor, a row of tiles per task.
#pragma once

#include "io/dag/colours/dag_colours.h"
#include "io/dag/dag_file.h"
#include "io/dag/layers/layer_index.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/trace/clip.h"
#include "verify/trace/image.h"
#include "verify/trace/kernel/tree64_view.h"
#include "verify/trace/shade.h"

namespace svdag {

struct RenderConfig {
  int width = 1280;
  int height = 720;
  int supersample = 2;                  // n x n rays per pixel
  bool beams = true;                    // false: every ray starts at the camera (same picture)
  std::optional<ClipBox> clip = {};     // the voxels that are shown; none: all
  LayerIndexView layers = {};           // of the file, if it has layers; else without entries
  std::span<const Vec3> albedos = {};   // [layer]: the part of light that it reflects
  const ColourView* colours = nullptr;  // of the file, if it has colours: instead of its layers'
};

// The colours of a file, else those of its layers, for pictures.
class ShownColours {
 public:
  // `file` must outlive this. Without colours and layers there is nothing to show. Error: kMemory,
  // and kBadInput if the file's colours are damaged.
  explicit ShownColours(const DagFile& file);
  bool empty() const { return !colours_ && !index_; }
  // Shows them in a picture; this must outlive its rendering.
  void show_in(RenderConfig* picture) const;

 private:
  MemoryBudget budget_;
  std::optional<DagColours> colours_;
  std::optional<LayerIndex> index_;
  std::vector<Vec3> albedos_;
};

// Upper bound of the rays of a picture that have no cut: those that a 64-tree can trace.
uint64_t uncut_rays(const DagView& dag, const Shading& shading, const RenderConfig& config);

// `tree`: the 64-tree of the DAG, or an empty one; the picture is the same.
Image render(const DagView& dag, const Tree64View& tree, const Camera& camera,
             const Shading& shading, const RenderConfig& config, Executor& executor,
             Progress& progress);

}  // namespace svdag
