#include "verify/trace/rays.h"

#include "verify/trace/processor.h"

namespace svdag {

void trace_closest(const DagView& dag, const Ray* rays, size_t count, const Span& span,
                   const Cut& cut, Hit* hits) {
  run_fast([&] {
    Tracer tracer(dag);
    for (size_t i = 0; i < count; ++i) hits[i] = tracer.closest(rays[i], span, cut);
  });
}

void trace_any(const DagView& dag, const Ray* rays, size_t count, const Span& span, const Cut& cut,
               uint8_t* found) {
  run_fast([&] {
    Tracer tracer(dag);
    for (size_t i = 0; i < count; ++i) found[i] = tracer.closest(rays[i], span, cut).found;
  });
}

}  // namespace svdag
