// Traces many rays at once on the processor.
#pragma once

#include <cstddef>

#include "verify/trace/kernel/traverse.h"
#include "verify/trace/kernel/tree64_view.h"

namespace svdag {

// hits[i] is the hit of rays[i].
void trace_closest(const DagView& dag, const Ray* rays, size_t count, const Span& span,
                   const Cut& cut, Hit* hits);
// found[i] is 1 if rays[i] meets a solid cube, else 0.
void trace_any(const DagView& dag, const Ray* rays, size_t count, const Span& span, const Cut& cut,
               uint8_t* found);

// The same through the DAG's 64-tree. Falls back to the file if the tree is empty, rays are cut, or
// the processor lacks AVX2. More rays per call are faster; 64 suffice.
void trace_closest(const DagView& dag, const Tree64View& tree, const Ray* rays, size_t count,
                   const Span& span, const Cut& cut, Hit* hits);
void trace_any(const DagView& dag, const Tree64View& tree, const Ray* rays, size_t count,
               const Span& span, const Cut& cut, uint8_t* found);

}  // namespace svdag
