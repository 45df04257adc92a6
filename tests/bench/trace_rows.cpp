// `trace_rows FILE.svdag SCENE LIGHT VIEW...`: MRays/s of one thread through the DAG and, by
// Embree, through the triangles, as CSV.
//
// LIGHT is x,y,z,r0,r1,...; VIEW is px,py,pz,tx,ty,tz,fov; both are in world units. Each result is
// the median of kRounds rounds, in each of which every method traces the same rays once. Time is
// CPU time of the thread, so that other load counts little.
#include "tests/bench/trace_rows.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>

#include "streaming/error.h"
#include "tests/bench/relaid_dag.h"
#include "tests/verify/trace/plain_traversal.h"
#include "verify/sample/snapped_scene.h"
#include "verify/trace/judge/voxel_triangle.h"
#include "verify/trace/kernel/beam.h"
#include "verify/trace/kernel/processor.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/tree64.h"

namespace svdag::bench {
namespace {

constexpr int kRounds = 3;
constexpr size_t kBundle = kTile * kTile;  // rays of one beam
constexpr double kReaches[] = {1,
                               0.05};  // length of ambient occlusion rays / diagonal of the scene
constexpr double kConeSpread = 0.3167688806490681;  // 2 tan(9 degrees): 0.077 sr, the paper's cone

using Method = std::function<RayRun(const RayBatch&)>;

struct Contestant {
  const char* name;
  Method trace;
};

// Traces rays as svdag-trace does: through the 64-tree, or through the DAG if `tree` is empty.
Method in_batches(const DagView& dag, const Tree64View& tree = {}, const Cut& cut = {}) {
  return [&dag, tree, cut](const RayBatch& batch) {
    const size_t count = batch.rays.size();
    std::vector<uint8_t> found(batch.any ? count : 0);
    std::vector<Hit> hits(batch.any ? 0 : count);
    RayRun run;
    const double start = thread_seconds();
    if (batch.any) {
      trace_any(dag, tree, batch.rays.data(), count, batch.span, cut, found.data());
    } else {
      trace_closest(dag, tree, batch.rays.data(), count, batch.span, cut, hits.data());
    }
    run.seconds = thread_seconds() - start;
    for (const uint8_t one : found) run.hits += one;
    for (const Hit& hit : hits) run.hits += hit.found;
    return run;
  };
}

// The same with beams: each bundle of kBundle rays within the span of its beam. A bundle is a tile
// of pixels, or the rays from one pixel to a light (which the 64-tree traces faster without a
// beam). Rays of ambient occlusion have no common direction.
Method in_beams(const DagView& dag, const Tree64View& tree = {}) {
  const Method without = in_batches(dag, tree);
  return [&dag, tree, without](const RayBatch& batch) {
    if (batch.name.starts_with("ao") || (batch.any && !tree.empty())) return without(batch);
    RayRun run;
    Hit hits[kBundle];
    uint8_t found[kBundle];
    const double start = thread_seconds();
    for (size_t i = 0; i < batch.rays.size(); i += kBundle) {
      const Ray* rays = &batch.rays[i];
      const size_t count = std::min(kBundle, batch.rays.size() - i);
      Span span;
      run_fast([&] {
        Beam beam;
        for (size_t k = 0; k < count; ++k) beam.add(rays[k]);
        span = beam.reach(dag, batch.span, {}, batch.any);
      });
      if (!(span.begin < span.end)) continue;
      if (batch.any) {
        trace_any(dag, tree, rays, count, span, {}, found);
      } else {
        trace_closest(dag, tree, rays, count, span, {}, hits);
      }
      for (size_t k = 0; k < count; ++k) run.hits += batch.any ? found[k] : hits[k].found;
    }
    run.seconds = thread_seconds() - start;
    return run;
  };
}

// Traces rays one by one; `trace_one(ray, span)` returns whether there is a hit.
template <class TraceOne>
Method one_by_one(const TraceOne& trace_one, bool fast) {
  return [trace_one, fast](const RayBatch& batch) {
    RayRun run;
    const auto all = [&] {
      for (const Ray& ray : batch.rays) run.hits += trace_one(ray, batch.span);
    };
    const double start = thread_seconds();
    if (fast) {
      run_fast(all);
    } else {
      all();
    }
    run.seconds = thread_seconds() - start;
    return run;
  };
}

std::vector<Contestant> ours(const DagView& dag, const Tree64View& tree,
                             const RelaidDag& as_in_file, const RelaidDag& levels,
                             const RelaidDag& one) {
  const auto plain = [&dag](const Ray& ray, const Span& span) {
    return plain_closest(dag, ray, span).found;
  };
  const auto from_root = [&dag](const Ray& ray, const Span& span) {
    return Tracer(dag).closest(ray, span).found;
  };
  return {{"svdag", in_beams(dag, tree)},
          {"svdag, without beams", in_batches(dag, tree)},
          {"svdag, the file", in_beams(dag)},
          {"svdag, the file, without beams", in_batches(dag)},
          {"svdag, plain", one_by_one(plain, true)},
          {"svdag, from the root", one_by_one(from_root, true)},
          {"svdag, from the root, old instructions", one_by_one(from_root, false)},
          {"svdag, huge pages", in_batches(as_in_file.view())},
          {"svdag, cut", in_batches(dag, {}, {0xffffffffU, kConeSpread})},
          {"svdag, depth-first", in_batches(levels.view())},
          {"svdag, depth-first, one section", in_batches(one.view())}};
}

std::vector<Contestant> embree(const EmbreePeer& peer) {
  using Way = EmbreePeer::Way;
  const auto with = [&](Way way, bool coherent) {
    return [&peer, way, coherent](const RayBatch& batch) {
      return batch.any ? peer.any(batch.float_rays, way, coherent)
                       : peer.closest(batch.float_rays, way, coherent);
    };
  };
  return {{"Embree, 1", with(Way::kSingle, false)},
          {"Embree, 8", with(Way::kPacket8, false)},
          {"Embree, 8 coherent", with(Way::kPacket8, true)},
          {"Embree, 16", with(Way::kPacket16, false)},
          {"Embree, 16 coherent", with(Way::kPacket16, true)},
          {"Embree, stream coherent", with(Way::kStream, true)}};
}

// Fails unless all methods of svdag except for the cone give the same hits.
void require_same_hits(const RayBatch& batch, const std::vector<Contestant>& contestants,
                       const std::vector<uint64_t>& hits) {
  std::set<uint64_t> exact;
  for (size_t i = 0; i < contestants.size(); ++i) {
    const std::string name = contestants[i].name;
    if (name.starts_with("svdag") && name != "svdag, cut") exact.insert(hits[i]);
  }
  if (exact.size() > 1)
    throw Error(ExitCode::kDiffers, batch.name + ": the methods give different hits");
}

void measure(const RayBatch& batch, const std::vector<Contestant>& contestants) {
  std::vector<std::vector<double>> seconds(contestants.size());
  std::vector<uint64_t> hits(contestants.size());
  for (int round = 0; round < kRounds; ++round) {
    for (size_t i = 0; i < contestants.size(); ++i) {
      const RayRun run = contestants[i].trace(batch);
      seconds[i].push_back(run.seconds);
      hits[i] = run.hits;
    }
  }
  require_same_hits(batch, contestants, hits);
  for (size_t i = 0; i < contestants.size(); ++i) {
    std::sort(seconds[i].begin(), seconds[i].end());
    std::printf("%s,%zu,\"%s\",%.4f,%llu\n", batch.name.c_str(), batch.rays.size(),
                contestants[i].name, 1e-6 * double(batch.rays.size()) / seconds[i][kRounds / 2],
                static_cast<unsigned long long>(hits[i]));
  }
  std::fflush(stdout);
}

std::vector<double> numbers(const char* text) {
  std::vector<double> values;
  const char* end = text + std::char_traits<char>::length(text);
  while (text < end) {
    double value = 0;
    const auto [next, error] = std::from_chars(text, end, value);
    if (error != std::errc()) fail_usage(std::string("not a list of numbers: ") + text);
    values.push_back(value);
    text = next + (next < end);
  }
  return values;
}

Vec3 to_voxels(const Grid& grid, const double* world) {
  const Point corner = grid.corner();
  Vec3 result;
  for (int a = 0; a < 3; ++a) result[a] = (world[a] - corner[a]) / grid.voxel_size;
  return result;
}

ViewConfig views(const Grid& grid, const VoxelBounds& box, char** light, char** end) {
  ViewConfig config;
  const std::vector<double> at = numbers(*light);
  config.light = to_voxels(grid, at.data());
  for (size_t i = 3; i < at.size(); ++i) config.light_radii.push_back(at[i] / grid.voxel_size);
  for (const double share : kReaches) config.reaches.push_back(share * length(box.max - box.min));
  for (char** view = light + 1; view < end; ++view) {
    const std::vector<double> v = numbers(*view);
    if (v.size() != 7) fail_usage("a view has seven numbers: px,py,pz,tx,ty,tz,fov");
    config.cameras.push_back(look_at(to_voxels(grid, &v[0]), to_voxels(grid, &v[3]), 1, v[6],
                                     double(config.width) / config.height));
  }
  return config;
}

std::vector<FloatTriangle> load(const char* path, const Grid& grid, const Vec3& middle) {
  SceneConfig config;
  config.paths = {path};
  MemoryBudget budget;
  std::vector<FloatTriangle> triangles;
  stream_snapped(Scene(config, &budget), grid, nullptr,
                 [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
                   for (const LatticeTriangle& lattice : batch) {
                     const VoxelTriangle t = in_voxels(lattice, grid.fraction());
                     FloatTriangle& to = triangles.emplace_back();
                     for (int i = 0; i < 9; ++i)
                       to.v[i / 3][i % 3] = float(t.v[i / 3][i % 3] - middle[i % 3]);
                   }
                 });
  return triangles;
}

int run(int argc, char** argv) {
  if (argc < 5) fail_usage("usage: trace_rows FILE.svdag SCENE LIGHT VIEW...");
  const DagFile file = DagFile::open(argv[1]);
  const DagView& dag = file.view();
  const double half = dag.resolution() / 2;
  const Vec3 middle{{half, half, half}};
  const std::vector<FloatTriangle> triangles = load(argv[2], file.grid(), middle);
  const EmbreePeer peer(triangles);
  const ViewConfig config = views(file.grid(), framing_bounds(dag), argv + 3, argv + argc);
  const Tree64 tree(dag);
  const RelaidDag as_in_file(dag, RelaidDag::Layout::kAsInFile);
  const RelaidDag levels(dag, RelaidDag::Layout::kDepthFirst);
  const RelaidDag one(dag, RelaidDag::Layout::kDepthFirstOneSection);
  std::vector<Contestant> contestants = ours(dag, tree.view(), as_in_file, levels, one);
  for (const Contestant& contestant : embree(peer)) contestants.push_back(contestant);
  std::printf("workload,rays,method,mrays,hits\n");
  for (const RayBatch& batch : make_batches(dag, config, middle)) measure(batch, contestants);
  return 0;
}

}  // namespace
}  // namespace svdag::bench

int main(int argc, char** argv) {
  try {
    return svdag::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "trace_rows: %s\n", error.what());
    return 2;
  }
}
