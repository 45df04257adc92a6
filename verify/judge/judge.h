// The interface of the two judges that decide which voxels a triangle sets.
//
//   integer   clips the triangle by columns of cells, or enumerates its lines of centres, in
//             integers (clip_judge.h, centre_lines.h)
//   cgal      tests one cell after the other with CGAL's exact kernel (judge_cgal.h)
//
// They share neither arithmetic nor method, except for the box of cells that they test
// (judge_cells.h), so each detects errors of the other. Both judge every rule
// (docs/accuracy.md); for the solid rules they judge which voxels are touched, and how a triangle
// changes winding numbers, which decide about the others (verify/sample/solid.h). A judge reuses
// scratch memory: one per thread. Voxels of a cut-out triangle are judged one by one
// (io/scene/cutouts/cut_triangle.h), without what the builder knows of cubes and bricks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dag/format.h"
#include "io/scene/cutouts/cut_records.h"
#include "verify/judge/centre_lines.h"
#include "verify/judge/clip_judge.h"

namespace svdag {

class Judge {
 public:
  using Sink = Clipper::Sink;

  virtual ~Judge() = default;
  // Passes every cell of side 2^shift inside `window` that the closed triangle meets to `sink`.
  // With any rule, a triangle sets voxels in these cells only.
  virtual void cells(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
                     const Sink& sink) = 0;
  // Passes every voxel (of side 2^fraction) that the rule sets to `sink`, at least once.
  virtual void voxels(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
                      const Sink& sink) = 0;
  // As winding_changes() (centre_lines.h).
  virtual void windings(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
                        const WindingSink& sink) = 0;
  // True if the triangle meets the closed cell.
  bool touches(const LatticeTriangle& triangle, int shift, const LatticePoint& cell);
};

struct JudgeChoice {
  enum class Kind { kInteger, kCgal };

  Kind kind = Kind::kInteger;
  Rule rule = Rule::kConservative;
  LayerKind layer = LayerKind::kNone;  // the scene is one layer of this kind; kNone: all of it
  const CutScene* cuts = nullptr;      // of the triangles; null: all are whole
};

// kCgal in a build without CGAL is an Error (kUsage).
std::unique_ptr<Judge> make_judge(const JudgeChoice& choice);
std::vector<std::unique_ptr<Judge>> make_judges(const JudgeChoice& choice, size_t count);

// The names "integer" and "cgal", and a description for people.
JudgeChoice::Kind parse_judge(const std::string& name);
const char* name_of(JudgeChoice::Kind kind);
const char* description_of(JudgeChoice::Kind kind, Rule rule);

}  // namespace svdag
