#include "verify/judge/judge.h"

#include <utility>

#include "io/scene/cutouts/cut_triangle.h"
#include "streaming/error.h"
#include "verify/judge/judge_cgal.h"

namespace svdag {
namespace {

class IntegerJudge final : public Judge {
 public:
  explicit IntegerJudge(Rule rule) : rule_(rule) {}

  void cells(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
             const Sink& sink) override {
    clipper_.run(triangle, shift, window, sink);
  }
  void voxels(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
              const Sink& sink) override {
    if (rule_ == Rule::kThin) return thin_voxels(triangle, fraction, window, sink);
    clipper_.run(triangle, fraction, window, sink);
  }
  void windings(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
                const WindingSink& sink) override {
    winding_changes(triangle, fraction, window, sink);
  }

 private:
  Rule rule_;
  Clipper clipper_;
};

// Of what another judge finds, the voxels with an opaque point.
class CutJudge final : public Judge {
 public:
  CutJudge(std::unique_ptr<Judge> whole, const CutScene& cuts, Rule rule)
      : whole_(std::move(whole)), cuts_(cuts), rule_(rule) {}

  void cells(const LatticeTriangle& triangle, int shift, const VoxelBox& window,
             const Sink& sink) override {
    whole_->cells(triangle, shift, window, sink);
  }
  void voxels(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
              const Sink& sink) override {
    if (triangle.cut == 0) return whole_->voxels(triangle, fraction, window, sink);
    const CutRecord& record = cuts_.records[triangle.cut - 1];
    const CutOut& cut = cuts_.cut_outs[record.material];
    const int64_t voxel = int64_t(1) << fraction;
    whole_->voxels(triangle, fraction, window, [&](const CellRun& run) {
      CellRun one = run;
      one.count = 1;
      for (int64_t n = 0; n < run.count; ++n, ++one.first[run.axis]) {
        if (is_opaque_in_voxel(cut, {triangle, record.corners}, one.first * voxel, voxel,
                               rule_ == Rule::kThin))
          sink(one);
      }
    });
  }
  void windings(const LatticeTriangle& triangle, int fraction, const VoxelBox& window,
                const WindingSink& sink) override {
    whole_->windings(triangle, fraction, window, sink);
  }

 private:
  std::unique_ptr<Judge> whole_;
  const CutScene& cuts_;
  Rule rule_;
};

}  // namespace

bool Judge::touches(const LatticeTriangle& triangle, int shift, const LatticePoint& cell) {
  bool hit = false;
  cells(triangle, shift, {cell, cell + int64_t(1)}, [&](const CellRun&) { hit = true; });
  return hit;
}

std::unique_ptr<Judge> make_judge(const JudgeChoice& choice) {
  std::unique_ptr<Judge> judge = choice.kind == JudgeChoice::Kind::kCgal
                                     ? make_cgal_judge(choice.rule)
                                     : std::make_unique<IntegerJudge>(choice.rule);
  if (choice.cuts == nullptr) return judge;
  return std::make_unique<CutJudge>(std::move(judge), *choice.cuts, choice.rule);
}

std::vector<std::unique_ptr<Judge>> make_judges(const JudgeChoice& choice, size_t count) {
  std::vector<std::unique_ptr<Judge>> judges;
  for (size_t i = 0; i < count; ++i) judges.push_back(make_judge(choice));
  return judges;
}

JudgeChoice::Kind parse_judge(const std::string& name) {
  for (const auto kind : {JudgeChoice::Kind::kInteger, JudgeChoice::Kind::kCgal}) {
    if (name == name_of(kind)) return kind;
  }
  fail_usage("--judge " + name + ": unknown judge: choose integer, cgal or openvdb");
}

const char* name_of(JudgeChoice::Kind kind) {
  return kind == JudgeChoice::Kind::kCgal ? "cgal" : "integer";
}

const char* description_of(JudgeChoice::Kind kind, Rule rule) {
  if (kind == JudgeChoice::Kind::kCgal)
    return is_solid(rule) ? "CGAL's exact kernel, winding numbers along lines of centres"
                          : "CGAL's exact kernel";
  if (is_solid(rule)) return "exact clipping, winding numbers along lines of centres";
  return rule == Rule::kThin ? "exact lines of centres" : "exact clipping";
}

}  // namespace svdag
