// svdag-trace as it is built without nvcc.
#include "streaming/error.h"
#include "verify/trace/program/device.h"

namespace svdag {

Answers trace_on_cuda(const PlainFile&, const Workload&) {
  fail_usage("--device cuda: this svdag-trace was built without CUDA (make cuda builds the other)");
}

}  // namespace svdag
