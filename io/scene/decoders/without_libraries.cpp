// Replaces draco.cpp and meshopt.cpp in builds without these libraries.
#include "io/scene/decoders/draco.h"
#include "io/scene/decoders/meshopt.h"
#include "streaming/error.h"

namespace svdag {

#ifndef SVDAG_HAS_DRACO
bool has_draco() {
  return false;
}

size_t decode_draco(std::span<const DracoSource>, const std::string& path, const MemoryBudget&,
                    bool, const DracoReceiver&) {
  fail_input(path, "is compressed with Draco, which this build of svdag cannot read");
}
#endif

#ifndef SVDAG_HAS_MESHOPT
bool has_meshopt() {
  return false;
}

void decode_meshopt(const MeshoptSource& source, const MeshoptView&, const MemoryBudget&,
                    const BlockSink&) {
  fail_input(source.path,
             "is compressed with EXT_meshopt_compression, which this build of svdag cannot read");
}
#endif

}  // namespace svdag
