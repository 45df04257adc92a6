// Replaces assimp.cpp in builds without the Assimp library.
#ifndef SVDAG_HAS_ASSIMP

#include "io/scene/mesh/mesh_reader.h"
#include "streaming/error.h"

namespace svdag {

void read_with_assimp(const File& file, const std::string& format, const ReadOptions&,
                      const TriangleSink&) {
  fail_input(file.path(), "is " + format + ", which this build of svdag cannot read: " +
                              "open it in Blender and export it as .glb");
}

}  // namespace svdag

#endif
