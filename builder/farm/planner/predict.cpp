#include "builder/farm/planner/predict.h"

#include <algorithm>
#include <cmath>

#include "builder/build.h"
#include "builder/reduce/run.h"

namespace svdag {
namespace {

// Seconds, as printed by tests/bench/plan.py --calibrate.
constexpr double kStart = 0.00844;       // start of a process
constexpr double kTriangle = 777.3e-9;   // read, snapped or from a bin, and prepared
constexpr double kDivided = 319.7e-9;    // a cube divided
constexpr double kComputed = 168.2e-9;   // a node computed for the plane memo
constexpr double kFound = 193.3e-9;      // a unique node: numbered, sorted, written
constexpr double kMergeRead = 83.46e-9;  // a node that a merge reads
constexpr double kNodeInFile = 22.4;  // bytes of a node in a .svdag

constexpr uint64_t kMiB = uint64_t(1) << 20;

// A budget with which any bake succeeds.
uint64_t min_budget(size_t threads) {
  return (64 + 16 * threads) * kMiB;
}

uint64_t budget_for(double need, const StepLimits& limits) {
  const uint64_t min = min_budget(limits.threads);
  const uint64_t max = limits.memory != 0 ? std::max(limits.memory, min) : UINT64_MAX;
  const double whole = std::ceil(need / double(kMiB)) * double(kMiB);
  return std::clamp(uint64_t(std::min(whole, 1e18)), min, max);
}

}  // namespace

double descent_cpu(double divided, double computed) {
  return kDivided * divided + kComputed * computed;
}

double cpu_of_bake(double cost, const NodeCounts& found, uint64_t triangles) {
  return kStart + kTriangle * double(triangles) + cost + kFound * found.keys();
}

Prediction predict_shard(const ShardWork& shard, const StepLimits& limits) {
  // A table gets half of the budget, a bin's triangles a quarter (builder/bake/bake.cpp). The
  // margin covers errors of the estimated node counts.
  constexpr double kMargin = 1.5, kPerTriangle = 400;
  const double tables =
      2 * (kFreezeBytesPerNode * shard.found.nodes + kFreezeBytesPerBrick * shard.found.bricks);
  const double bin = 4 * kPerTriangle * double(shard.heaviest_bin);
  Prediction p;
  p.cpu = cpu_of_bake(shard.cost, shard.found, shard.triangles);
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

}  // namespace svdag
