// Replaces judge_cgal.cpp in builds without CGAL.
#ifndef SVDAG_HAS_CGAL

#include "streaming/error.h"
#include "verify/judge/judge_cgal.h"

namespace svdag {

std::unique_ptr<Judge> make_cgal_judge(Rule) {
  fail_usage(
      "this svdag-verify was built without CGAL: use --judge integer, or build it with "
      "-DSVDAG_CGAL=ON");
}

}  // namespace svdag

#endif
