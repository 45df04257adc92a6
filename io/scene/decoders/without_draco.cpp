// Replaces draco.cpp in builds without the Draco library.
#ifndef SVDAG_HAS_DRACO

#include "io/scene/decoders/draco.h"
#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {

bool has_draco() {
  return false;
}

DracoMesh decode_draco(const DracoSource& source, MemoryBudget*) {
  fail_input(source.path, "is compressed with Draco, which this build of svdag cannot read");
}

void read_draco(const File& file, const ReadOptions& options, const TriangleSink&) {
  decode_draco({{}, file.path()}, options.budget);
}

}  // namespace svdag

#endif
