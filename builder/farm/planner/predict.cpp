#include "builder/farm/planner/predict.h"

#include <algorithm>
#include <cmath>

#include "builder/build.h"
#include "builder/colours/prepared_triangles.h"
#include "builder/colours/spilled_colours.h"
#include "builder/reduce/run.h"
#include "builder/workspace/memory_shares.h"

namespace svdag {
namespace {

// Seconds, as tests/bench/plan.py --calibrate printed them.
constexpr double kStart = 0.0101;        // start of a process
constexpr double kTriangle = 128e-9;     // read and snapped, or from a bin
constexpr double kSpilled = 95.18e-9;    // more, if it is spilled
constexpr double kFound = 173.7e-9;      // a unique node: numbered, sorted, written
constexpr double kMergeRead = 104.1e-9;  // a node that a merge reads
constexpr double kNodeInFile = 22.4;     // bytes of a node in a .svdag
constexpr double kReadAlone = 147.5e-9;  // wall time of a triangle until it is in a bin
// Of the colour pass, fitted by hand to nine textured scenes: right within a factor of two.
constexpr double kPainted = 1200e-9;   // a triangle: read, snapped, prepared
constexpr double kTexel = 60e-9;       // decoded, with its mip map
constexpr double kPair = 400e-9;       // a triangle and a cube
constexpr double kCube = 450e-9;       // spilled, encoded, written
constexpr double kColourInFile = 0.5;  // bytes of a cube's colours at the default error

constexpr double kComputed = 0.33;  // work of a node computed for the plane memo, in cubes
constexpr double kProcess = 25e6;   // bytes of memory that no input needs
constexpr uint64_t kMiB = uint64_t(1) << 20;

uint64_t budget_for(double need, const StepLimits& limits) {
  const uint64_t min = kBaseBudget + limits.threads * kThreadBudget;
  const uint64_t max = limits.memory != 0 ? std::max(limits.memory, min) : UINT64_MAX;
  const double whole = std::ceil(need / double(kMiB)) * double(kMiB);
  return std::clamp(uint64_t(std::min(whole, 1e18)), min, max);
}

double freeze_bytes(const NodeCounts& found) {
  return kFreezeBytesPerNode * found.nodes + kFreezeBytesPerBrick * found.bricks;
}

}  // namespace

double descent_work(double divided, double computed) {
  return divided + kComputed * computed;
}

double cpu_of_bake(double cost, const NodeCounts& found, uint64_t triangles, bool spilled) {
  const double each = kTriangle + (spilled ? kSpilled : 0);
  return kStart + each * double(triangles) + cost + kFound * found.keys();
}

double seconds_of_bake(double cpu, uint64_t triangles, size_t threads) {
  const double alone = kStart + kReadAlone * double(triangles);
  return alone + (cpu - alone) / double(threads);
}

// The shares are those of builder/workspace/memory_shares.h. A bin's tree takes about half of its
// share, and a table has less than freeze_bytes() when it is emptied.
uint64_t memory_of_bake(const NodeCounts& found, uint64_t triangles, bool spilled, uint64_t limit) {
  constexpr double kTriangleInTree = 56, kOfFreezeBytes = 0.8;
  const MemoryShares shares(limit);
  const double tree = spilled ? double(shares.triangles) / 2 : kTriangleInTree * double(triangles);
  const double tables = std::min(freeze_bytes(found), double(shares.table));
  return uint64_t(kProcess + tree + kOfFreezeBytes * tables);
}

Prediction predict_shard(const ShardWork& shard, const StepLimits& limits) {
  // A table gets half of the budget, a bin's triangles a quarter (builder/bake/bake.cpp). The
  // margin covers errors of the estimated node counts.
  constexpr double kMargin = 1.5, kPerTriangle = 400;
  const double tables = 2 * freeze_bytes(shard.found);
  const double bin = 4 * kPerTriangle * double(shard.heaviest_bin);
  Prediction p;
  p.cpu = cpu_of_bake(shard.cost, shard.found, shard.triangles, false);
  p.seconds = kStart + (p.cpu - kStart) / double(limits.threads);
  p.budget = budget_for(kMargin * std::max(tables, bin), limits);
  p.memory = p.budget + kBesideBudget;
  p.output = uint64_t(shard.found.run_bytes());
  const bool spills = tables > double(p.budget) || p.seconds > kCheckpointSeconds;
  p.scratch = spills ? uint64_t(kMargin * 2 * shard.found.run_bytes()) : 0;
  return p;
}

Prediction predict_merge(const NodeCounts& read, const NodeCounts& made, bool last,
                         const StepLimits& limits) {
  constexpr double kRankBytes = 4, kMargin = 1.5;
  Prediction p;
  p.cpu = kStart + kMergeRead * read.keys();
  p.seconds = kStart + (p.cpu - kStart) / double(limits.threads);
  const double maps = 2 * kRankBytes * read.keys();
  p.budget = budget_for(kMargin * 2 * maps, limits);
  p.memory = p.budget + kBesideBudget;
  p.output = uint64_t(last ? kNodeInFile * made.nodes + 8 * made.bricks : made.run_bytes());
  p.scratch = 2 * maps > double(p.budget) ? uint64_t(kMargin * (read.run_bytes() + maps)) : 0;
  return p;
}

Prediction predict_colours(const ColourWork& work, uint64_t file, const StepLimits& limits) {
  // A quarter of the budget holds triangles; half may hold images. To spill many triangles costs a
  // tenth of the time, so they do not need a large machine.
  constexpr double kMargin = 1.5, kShareOfTriangles = 4, kShareOfImages = 2;
  constexpr double kMaxForTriangles = double(1024 * kMiB);
  const double serial = kStart + kPainted * double(work.triangles) + kTexel * double(work.texels);
  const double parallel = kPair * work.pairs + kCube * work.cubes;
  const double triangles = double(PreparedTriangles::kBytes) * double(work.triangles);
  const double images = double(LinearImage::bytes(work.texels));
  Prediction p;
  p.cpu = serial + parallel;
  p.seconds = serial + parallel / double(limits.threads);
  p.budget =
      budget_for(std::max({kMargin * double(work.read_bytes), kShareOfImages * images,
                           std::min(kMargin * kShareOfTriangles * triangles, kMaxForTriangles)}),
                 limits);
  p.memory = p.budget + kBesideBudget;
  p.output = file + uint64_t(kColourInFile * work.cubes);
  const bool spills = kShareOfTriangles * triangles > double(p.budget);
  p.scratch = uint64_t(double(SpilledColours::kEntryBytes) * work.cubes +
                       (spills ? kMargin * sizeof(PaintedTriangle) * double(work.triangles) : 0));
  return p;
}

uint64_t memory_of_colours(const ColourWork& work, uint64_t limit) {
  const double triangles = std::min(double(PreparedTriangles::kBytes) * double(work.triangles),
                                    double(MemoryShares(limit).triangles));
  const double images = double(LinearImage::bytes(work.texels));
  return uint64_t(kProcess + std::max(double(work.read_bytes), images + triangles));
}

}  // namespace svdag
