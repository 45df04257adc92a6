// Arbitrary bytes as the .svdag that svdag-trace reads by itself: an Error, or a file that can be
// traced, with the same hits through its pointers as through its 64-tree. svdag-trace accepts
// every file that svdag-verify check accepts.
#include <cstdlib>
#include <vector>

#include "io/dag/dag_file.h"
#include "tests/fuzz/file_fuzz.h"
#include "tests/repair_checksums.h"
#include "verify/trace/kernel/rays.h"
#include "verify/trace/kernel/tree64.h"
#include "verify/trace/kernel/workload.h"
#include "verify/trace/presets.h"
#include "verify/trace/program/plain_file.h"

namespace svdag {
namespace {

constexpr uint32_t kSide = 8;  // of the picture
constexpr size_t kLayers = 4;  // that are traced alone

bool is_sound(std::string bytes) {
  repair_checksums(&bytes);
  const MemoryFile memory(bytes);
  try {
    DagFile::open(memory.file().path());
  } catch (const Error&) {
    return false;
  }
  return true;
}

void trace(const DagView& dag) {
  const Camera camera = preset_camera("iso", dag, framing_bounds(dag), 1, Camera::kDefaultFov, 1.0);
  const Picture picture{camera, kSide, kSide};
  std::vector<Ray> rays;
  for (uint32_t i = 0; i < kSide * kSide; ++i) rays.push_back(picture.ray(i % kSide, i / kSide));
  std::vector<Hit> hits(rays.size()), by_tree(rays.size());
  trace_closest(dag, rays.data(), rays.size(), {}, {}, hits.data());
  const Tree64 tree(dag);
  trace_closest(dag, tree.view(), rays.data(), rays.size(), {}, {}, by_tree.data());
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit &one = hits[i], &two = by_tree[i];
    if (one.found != two.found) std::abort();
    if (!one.found) continue;
    const uint32_t* v = one.voxel;
    if (!dag_voxel(dag, v[0], v[1], v[2]) || one.t != two.t || one.axis != two.axis) std::abort();
    if (v[0] != two.voxel[0] || v[1] != two.voxel[1] || v[2] != two.voxel[2]) std::abort();
  }
}

}  // namespace
}  // namespace svdag

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace svdag;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const MemoryFile memory(bytes);
  bool taken = false;
  expect_only_errors([&] {
    PlainFile file = read_plain_file(memory.file().path());
    taken = true;
    if (!file.view.empty()) trace(file.view);
    for (size_t layer = 0; layer < file.layers.layers.size() && layer < kLayers; ++layer) {
      show_layer(&file, layer);
      if (!file.view.empty()) trace(file.view);
    }
  });
  if (!taken && is_sound(bytes)) std::abort();
  return 0;
}
