// Replaces openmesh.cpp in builds without the OpenMesh library.
#ifndef SVDAG_HAS_OPENMESH

#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {

void read_openmesh(const File& file, const ReadOptions&, const TriangleSink&) {
  fail_input(file.path(), "is an OpenMesh file, which this build of svdag cannot read");
}

}  // namespace svdag

#endif
