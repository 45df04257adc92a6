#include "verify/trace/kernel/rays.h"

#include <utility>

#include "verify/trace/kernel/cells64_avx2.h"
#include "verify/trace/kernel/processor.h"
#include "verify/trace/kernel/walk64.h"

namespace svdag {
namespace {

// Number of interleaved rays: while one waits for memory, the others proceed. More gain little.
constexpr int kInFlight = 8;

// The walks in progress, and the rays that have not started. Calls done(i, walk) when ray i ends.
template <class Done>
class RaysInFlight {
 public:
  RaysInFlight(const Tree64View& tree, const Ray* rays, size_t count, const Span& span,
               const Done& done)
      : tree_(tree), rays_(rays), count_(count), span_(span), done_(done) {
    for (int i = 0; i < kInFlight; ++i) walks_[i] = &storage_[i];
    while (active_ < kInFlight && fill(active_)) ++active_;
  }

  int active() const { return active_; }

  const Walk64& walk(int i) const { return walks_[i]->walk; }

  // Steps walk i. If it ends, the next ray replaces it; if no ray is left, the last active walk
  // becomes walk i and the result is false.
  bool step(int i, uint64_t cells) {
    if (walks_[i]->walk.step(tree_, cells)) [[likely]]
      return true;
    done_(walks_[i]->ray, walks_[i]->walk);
    if (fill(i)) return true;
    std::swap(walks_[i], walks_[--active_]);
    return false;
  }

 private:
  struct RayInFlight {
    Walk64 walk;
    size_t ray;
  };

  bool fill(int i) {
    for (; next_ < count_; ++next_) {
      walks_[i]->ray = next_;
      if (walks_[i]->walk.start(tree_, rays_[next_], span_)) {
        ++next_;
        return true;
      }
      done_(next_, walks_[i]->walk);
    }
    return false;
  }

  const Tree64View& tree_;
  const Ray* rays_;
  const size_t count_;
  const Span& span_;
  const Done& done_;
  size_t next_ = 0;
  int active_ = 0;
  RayInFlight* walks_[kInFlight];
  RayInFlight storage_[kInFlight];
};

// Walks all rays through the tree and calls done(i, walk) for each. Returns false, without having
// walked, on processors without AVX2: there the scalar walk is slower than tracing the file.
#if defined(__x86_64__)
template <class Done>
[[gnu::target(SVDAG_FAST_TARGET), gnu::flatten]] void walk_with_avx2(const Tree64View& tree,
                                                                     const Ray* rays, size_t count,
                                                                     const Span& span,
                                                                     const Done& done) {
  RaysInFlight<Done> walks(tree, rays, count, span, done);
  while (walks.active() > 0) {
    for (int i = 0; i < walks.active();) {
      const Walk64& walk = walks.walk(i);
      i += walks.step(i, Avx2Cells::of(tree, walk.times(), walk.visit()));
    }
  }
}

template <class Done>
bool walk_all(const Tree64View& tree, const Ray* rays, size_t count, const Span& span,
              const Done& done) {
  if (tree.empty() || !has_fast_target()) return false;
  walk_with_avx2(tree, rays, count, span, done);
  return true;
}
#else
template <class Done>
bool walk_all(const Tree64View&, const Ray*, size_t, const Span&, const Done&) {
  return false;
}
#endif

}  // namespace

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

void trace_closest(const DagView& dag, const Tree64View& tree, const Ray* rays, size_t count,
                   const Span& span, const Cut& cut, Hit* hits) {
  const auto done = [&](size_t i, const Walk64& walk) { hits[i] = walk.hit(tree); };
  if (cut.cuts(dag.levels) || !walk_all(tree, rays, count, span, done))
    trace_closest(dag, rays, count, span, cut, hits);
}

void trace_any(const DagView& dag, const Tree64View& tree, const Ray* rays, size_t count,
               const Span& span, const Cut& cut, uint8_t* found) {
  const auto done = [&](size_t i, const Walk64& walk) { found[i] = walk.found(); };
  if (cut.cuts(dag.levels) || !walk_all(tree, rays, count, span, done))
    trace_any(dag, rays, count, span, cut, found);
}

}  // namespace svdag
