// Replaces cuda.cu in builds without nvcc.
#include "streaming/error.h"
#include "verify/trace/program/device.h"

namespace svdag {

TraceResults trace_on_cuda(const PlainFile&, const Workload&) {
  fail_usage("--device cuda: this svdag-trace was built without CUDA: build it with make cuda");
}

}  // namespace svdag
