// Judges the colours of a .svdag by its scene: those of cubes drawn from the covered ones, each
// with the mean over the triangles inside (verify/colours/cube_estimate.h). The means of coarser
// cubes follow from these; verify/integrity checks them.
//
// A colour is wrong if a channel is off by more than the error of the file's codec, a step for
// rounding, two for decoders of JPEG, and the tolerance of the estimate. The scene is read once:
// the sorted Morton codes of the drawn cubes are an octree, down which each triangle goes. Shared
// with the builder: readers, the snap, the reader of the file. Not shared: clipping, texels,
// sampling, sums, and the choice of levels of textures.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/dag/dag_file.h"
#include "io/scene/scene.h"
#include "streaming/process/progress.h"

namespace svdag {

struct ColourDraw {
  uint64_t count = 10'000;  // of cubes; all if there are fewer
  uint64_t seed = 1;
};

struct WrongColour {
  LatticePoint cube;                 // of the colour level, in units of its side
  uint32_t stored = 0;               // r | g << 8 | b << 16, or kNoColour
  std::array<double, 3> expected{};  // sRGB, 0 .. 255
  std::array<double, 3> allowed{};   // largest difference, of steps
  double excess = 0;                 // beyond what is allowed; 255 for a cube without colour
};

struct ColourComparison {
  static constexpr size_t kShown = 20;

  uint64_t covered = 0;         // cubes of the colour level
  uint64_t drawn = 0;           // of them
  uint64_t without_colour = 0;  // drawn: stored without, and no triangle is there
  uint64_t without_mean = 0;    // drawn: triangles only touch the cube, or only transparent points
  uint64_t without_triangle = 0;  // drawn: with a colour; the scene is another one
  uint64_t judged = 0;            // of the colour level: the others that were drawn
  uint64_t wrong = 0;
  // Of the judged cubes' channels, in steps of sRGB, of colours of 8 bits; 0 without any.
  double mean = 0, permille_999 = 0, largest = 0;
  uint64_t at_seams = 0;           // judged: where parts of textures meet that are not neighbours
  double mean_at_seams = 0;        // of these, as `mean`
  double mean_allowed = 0;         // mean of the largest difference that is not wrong
  std::vector<WrongColour> worst;  // at most kShown, the largest excess first

  bool agrees() const { return wrong == 0; }
};

// `file` has colours; `scene` is read with `colours`, `paint` and `keep_images`. Errors as
// Scene::stream() and judged_texels().
ColourComparison compare_colours(const Scene& scene, const DagFile& file, const ColourDraw& draw,
                                 MemoryBudget* budget, Progress* progress);

}  // namespace svdag
