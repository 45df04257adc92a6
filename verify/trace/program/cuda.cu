// The workloads on an NVIDIA GPU: a thread per tile for beams, per pixel for primary and shadow
// rays, per ray for the others. The kernels call the same functions as the processor does;
// --fmad=false prevents fused operations, so the results are equal bit by bit.
#include <algorithm>
#include <string>

#include "streaming/error.h"
#include "verify/trace/kernel/tree64.h"
#include "verify/trace/kernel/walk64.h"
#include "verify/trace/program/device.h"

namespace svdag {
namespace {

constexpr unsigned kBlock = kTile * kTile;  // threads; a tile's pixels share a block
// Blocks per multiprocessor: a thread has 72 registers. With the 80 to 96 that it would take, too
// few rays are under way to hide the memory; 64 are no faster.
constexpr unsigned kBlocks = 14;

void check(cudaError_t status, const char* doing) {
  if (status == cudaSuccess) return;
  const std::string why = std::string(doing) + ": " + cudaGetErrorString(status);
  if (status == cudaErrorMemoryAllocation)
    throw Error(ExitCode::kMemory, why + "; choose a smaller --size or a coarser DAG");
  throw Error(ExitCode::kInternal, "the GPU failed while " + why);
}

// An array of `count` values in device memory.
template <typename T>
class DeviceArray {
 public:
  explicit DeviceArray(size_t count) : count_(count) {
    check(cudaMalloc(&data_, std::max<size_t>(count, 1) * sizeof(T)), "allocating GPU memory");
  }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() { cudaFree(data_); }  // a failure is ignored

  T* data() const { return data_; }
  void clear() const { check(cudaMemset(data_, 0, count_ * sizeof(T)), "clearing GPU memory"); }
  void upload(const T* from) const {
    check(cudaMemcpy(data_, from, count_ * sizeof(T), cudaMemcpyHostToDevice),
          "copying to the GPU");
  }
  void download(std::vector<T>* to) const {
    to->resize(count_);
    check(cudaMemcpy(to->data(), data_, count_ * sizeof(T), cudaMemcpyDeviceToHost),
          "copying from the GPU");
  }

 private:
  T* data_ = nullptr;
  size_t count_;
};

__global__ void beam_kernel(const __grid_constant__ DagView dag,
                            const __grid_constant__ Workload work, uint32_t columns, uint32_t tiles,
                            Span* spans) {
  const uint32_t tile = blockIdx.x * blockDim.x + threadIdx.x;
  if (tile >= tiles) return;
  spans[tile] = tile_span(dag, work.picture, tile % columns * kTile, tile / columns * kTile);
}

// What rays are traced through: the file, ...
struct FileTracer {
  DagView dag;
  __device__ Hit closest(const Ray& ray, const Span& span, const Cut& cut) const {
    return trace_closest(dag, ray, span, cut);
  }
};

// ... or the 64-tree of it, without cuts.
struct TreeTracer {
  Tree64View tree;
  __device__ Hit closest(const Ray& ray, const Span& span, const Cut&) const {
    Walk64 walk;
    if (walk.start(tree, ray, span)) {
      while (walk.step(tree, PlainCells::of(tree, walk.times(), walk.visit()))) {
      }
    }
    return walk.hit(tree);
  }
};

// One block per tile.
template <class Tracing>
__global__ void __launch_bounds__(kBlock, kBlocks)
    primary_kernel(const __grid_constant__ Tracing tracing, const __grid_constant__ Workload work,
                   uint32_t columns, const Span* spans, Hit* hits) {
  const uint32_t x = blockIdx.x % columns * kTile + threadIdx.x % kTile;
  const uint32_t y = blockIdx.x / columns * kTile + threadIdx.x / kTile;
  if (x >= work.picture.width || y >= work.picture.height) return;
  const Span span = work.beams ? spans[blockIdx.x] : Span{};
  hits[size_t(y) * work.picture.width + x] = tracing.closest(work.picture.ray(x, y), span, {});
}

__global__ void surfel_kernel(const __grid_constant__ DagView dag,
                              const __grid_constant__ Workload work, const Hit* hits,
                              Surfel* surfels) {
  const uint32_t pixel = blockIdx.x * blockDim.x + threadIdx.x;
  if (pixel >= work.picture.width * work.picture.height) return;
  const uint32_t x = pixel % work.picture.width, y = pixel / work.picture.width;
  surfels[pixel] = make_surfel(dag, work.picture.ray(x, y), hits[pixel]);
}

__global__ void layer_kernel(const __grid_constant__ DagView dag,
                             const __grid_constant__ LayerIndexView index, uint32_t pixels,
                             const Hit* hits, uint32_t* layers) {
  const uint32_t pixel = blockIdx.x * blockDim.x + threadIdx.x;
  if (pixel < pixels) layers[pixel] = layer_of_hit(dag, index, hits[pixel]);
}

// One thread per ray; the rays of a pixel are adjacent.
template <class Tracing>
__global__ void __launch_bounds__(kBlock, kBlocks)
    secondary_kernel(const __grid_constant__ Tracing tracing, const __grid_constant__ Workload work,
                     int kind, uint32_t per_pixel, const Surfel* surfels, uint32_t* blocked) {
  const uint64_t ray = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
  const uint64_t pixel = ray / per_pixel;
  if (pixel >= uint64_t(work.picture.width) * work.picture.height) return;
  if (!surfels[pixel].found) return;
  const Ray secondary = secondary_ray(work, kind, surfels[pixel], pixel, uint32_t(ray % per_pixel));
  if (tracing.closest(secondary, secondary_span(work, kind), secondary_cut(work, kind)).found)
    atomicAdd(&blocked[pixel], 1U);
}

// Calls launch(tracing) with the tree if there is one and rays are not cut.
template <typename Launch>
void with_tracing(const DagView& dag, const Tree64View& tree, const Cut& cut,
                  const Launch& launch) {
  if (tree.empty() || cut.cuts(dag.levels)) return launch(FileTracer{dag});
  launch(TreeTracer{tree});
}

unsigned blocks_for(uint64_t threads) {
  return unsigned((threads + kBlock - 1) / kBlock);
}

// The shortest time of `rounds` launches, in seconds.
template <typename Launch>
double min_seconds(uint32_t rounds, const Launch& launch) {
  struct Events {
    cudaEvent_t from = nullptr, to = nullptr;
    ~Events() {
      if (from != nullptr) cudaEventDestroy(from);
      if (to != nullptr) cudaEventDestroy(to);
    }
  } events;
  check(cudaEventCreate(&events.from), "creating a timer");
  check(cudaEventCreate(&events.to), "creating a timer");
  float best = 1e30F;
  for (uint32_t round = 0; round < rounds; ++round) {
    check(cudaEventRecord(events.from), "starting a timer");
    launch();
    check(cudaGetLastError(), "starting a kernel");
    check(cudaEventRecord(events.to), "stopping a timer");
    check(cudaEventSynchronize(events.to), "tracing");
    float milliseconds = 0;
    check(cudaEventElapsedTime(&milliseconds, events.from, events.to), "reading a timer");
    best = std::min(best, milliseconds);
  }
  return 1e-3 * double(best);
}

std::string device_name() {
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess || count == 0)
    fail_usage(std::string("--device cuda: no usable NVIDIA GPU (") +
               cudaGetErrorString(status == cudaSuccess ? cudaErrorNoDevice : status) + ")");
  cudaDeviceProp properties;
  check(cudaGetDeviceProperties(&properties, 0), "querying the device");
  return properties.name;
}

void require_free_memory(uint64_t bytes) {
  size_t free = 0, total = 0;
  check(cudaMemGetInfo(&free, &total), "querying free memory");
  if (bytes <= free) return;
  throw Error(ExitCode::kMemory, "the DAG and the picture need " + std::to_string(bytes >> 20) +
                                     " MiB of GPU memory, " + std::to_string(free >> 20) +
                                     " MiB are free: choose a coarser DAG or a smaller --size");
}

void trace_layers(const LayerIndex& index, const DagView& dag, const DeviceArray<Hit>& hits,
                  size_t pixels, std::vector<uint32_t>* layers) {
  const DeviceArray<uint32_t> begin(index.begin().size());
  const DeviceArray<LayerIndexView::Entry> entries(index.entries().size());
  const DeviceArray<uint32_t> found(pixels);
  begin.upload(index.begin().data());
  entries.upload(index.entries().data());
  layer_kernel<<<blocks_for(pixels), kBlock>>>(dag,
                                               {index.view().level, begin.data(), entries.data()},
                                               uint32_t(pixels), hits.data(), found.data());
  check(cudaGetLastError(), "starting a kernel");
  found.download(layers);
}

}  // namespace

TraceResults trace_on_cuda(const PlainFile& file, const Workload& work) {
  TraceResults results;
  results.device = device_name();
  const Picture& picture = work.picture;
  const size_t pixels = size_t(picture.width) * picture.height;
  const uint32_t columns = (picture.width + kTile - 1) / kTile;
  const uint32_t tiles = columns * ((picture.height + kTile - 1) / kTile);
  if (pixels * work.secondary.samples / kBlock >= 0x7fffffffU)
    fail_usage("--size, --samples: too many rays for a GPU: choose fewer");
  const uint64_t index_bytes = file.index ? file.index->begin().size_bytes() +
                                                file.index->entries().size_bytes() +
                                                pixels * sizeof(uint32_t)
                                          : 0;
  const Tree64 built = work.gpu_tree ? Tree64(file.view) : Tree64();
  require_free_memory(file.words.size() * 8 + built.bytes() + index_bytes + tiles * sizeof(Span) +
                      pixels * (sizeof(Hit) + sizeof(Surfel) + sizeof(uint32_t)));
  const DeviceArray<uint64_t> copy(file.words.size()), words(built.bytes() / sizeof(uint64_t));
  copy.upload(file.words.data());
  const DagView dag = moved_view(file.view, file.words.data(), copy.data());
  Tree64View tree = built.view();
  if (!tree.empty()) {
    words.upload(tree.words);
    tree.words = words.data();
  }
  const DeviceArray<Span> spans(tiles);
  const DeviceArray<Hit> hits(pixels);
  const DeviceArray<Surfel> surfels(pixels);
  const DeviceArray<uint32_t> blocked(pixels);
  results.rays[kPrimaryRays] = pixels;
  results.seconds[kPrimaryRays] = min_seconds(work.rounds, [&] {
    if (work.beams)
      beam_kernel<<<blocks_for(tiles), kBlock>>>(dag, work, columns, tiles, spans.data());
    with_tracing(dag, tree, {}, [&](const auto& tracing) {
      primary_kernel<<<tiles, kBlock>>>(tracing, work, columns, spans.data(), hits.data());
    });
  });
  surfel_kernel<<<blocks_for(pixels), kBlock>>>(dag, work, hits.data(), surfels.data());
  check(cudaGetLastError(), "starting a kernel");
  hits.download(&results.hits);
  surfels.download(&results.surfels);
  results.layers.assign(pixels, kNoLayer);
  if (file.index) trace_layers(*file.index, dag, hits, pixels, &results.layers);
  const auto found = uint64_t(std::count_if(results.hits.begin(), results.hits.end(),
                                            [](const Hit& hit) { return hit.found; }));
  for (int kind = kShadowRays; kind < kWorkloads; ++kind) {
    const uint32_t per_pixel = rays_per_pixel(work, kind);
    results.rays[kind] = found * per_pixel;
    results.seconds[kind] = min_seconds(work.rounds, [&] {
      blocked.clear();
      with_tracing(dag, tree, secondary_cut(work, kind), [&](const auto& tracing) {
        secondary_kernel<<<blocks_for(pixels * per_pixel), kBlock>>>(
            tracing, work, kind, per_pixel, surfels.data(), blocked.data());
      });
    });
    blocked.download(&results.blocked[kind]);
  }
  return results;
}

}  // namespace svdag
