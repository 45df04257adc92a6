#include "verify/judge/judge.h"

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

}  // namespace

bool Judge::touches(const LatticeTriangle& triangle, int shift, const LatticePoint& cell) {
  bool hit = false;
  cells(triangle, shift, {cell, cell + int64_t(1)}, [&](const CellRun&) { hit = true; });
  return hit;
}

std::unique_ptr<Judge> make_judge(const JudgeChoice& choice) {
  if (choice.kind == JudgeChoice::Kind::kCgal) return make_cgal_judge(choice.rule);
  return std::make_unique<IntegerJudge>(choice.rule);
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
