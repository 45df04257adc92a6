// Replaces meshopt.cpp in builds without the meshoptimizer library.
#ifndef SVDAG_HAS_MESHOPT

#include "io/scene/decoders/meshopt.h"
#include "streaming/error.h"

namespace svdag {

bool has_meshopt() {
  return false;
}

void decode_meshopt(const MeshoptSource& source, const MeshoptView&, const MemoryBudget&,
                    const BlockSink&) {
  fail_input(source.path,
             "is compressed with EXT_meshopt_compression, which this build of svdag cannot read");
}

}  // namespace svdag

#endif
