// Replaces judge_vdb.cpp in builds without OpenVDB.
#ifndef SVDAG_HAS_OPENVDB

#include "streaming/error.h"
#include "verify/judge/judge_vdb.h"

namespace svdag {

void vdb_distances(std::span<const Triangle>, size_t, const DistanceSink&) {
  fail_usage(
      "this svdag-verify was built without OpenVDB: use --judge integer, or build it with "
      "-DSVDAG_OPENVDB=ON");
}

}  // namespace svdag

#endif
