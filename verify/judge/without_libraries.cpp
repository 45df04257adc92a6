// Replaces judge_cgal.cpp and judge_vdb.cpp in builds without CGAL or OpenVDB.
#include "streaming/error.h"
#include "verify/judge/judge_cgal.h"
#include "verify/judge/judge_vdb.h"

namespace svdag {

#ifndef SVDAG_HAS_CGAL
std::unique_ptr<Judge> make_cgal_judge(Rule) {
  fail_usage(
      "this svdag-verify was built without CGAL: use --judge integer, or build it with "
      "-DSVDAG_CGAL=ON");
}
#endif

#ifndef SVDAG_HAS_OPENVDB
void vdb_distances(std::span<const Triangle>, size_t, const DistanceSink&) {
  fail_usage(
      "this svdag-verify was built without OpenVDB: use --judge integer, or build it with "
      "-DSVDAG_OPENVDB=ON");
}
#endif

}  // namespace svdag
