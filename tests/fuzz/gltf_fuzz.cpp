#include "io/scene/gltf/gltf_animation.h"
#include "tests/fuzz/reader_fuzz.h"

namespace {

svdag::LeftOut list_animations(const svdag::File& file, const svdag::ReadOptions& options,
                               svdag::MeshWriter*) {
  svdag::gltf_animations(file, options);
  return {};
}

}  // namespace

// At rest, at a time of its animations, and the list of these.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const svdag::PoseTime time{0.5};
  svdag::fuzz_reader(svdag::read_gltf, data, size, svdag::kDecoderMemory);
  svdag::fuzz_reader(list_animations, data, size, svdag::kDecoderMemory);
  return svdag::fuzz_reader(svdag::read_gltf, data, size, svdag::kDecoderMemory, &time);
}
