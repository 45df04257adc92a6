// A 64-tree in memory, built from a DAG, for tracing many rays.
//
// Takes two to three times the file's size on huge pages, and a third to half a microsecond per
// node of the DAG. Nodes are in depth-first order, so that the nodes that a ray meets are close
// together. It pays for many rays per node of the DAG; otherwise the mapped file is traced, with
// the same hits.
#pragma once

#include <vector>

#include "streaming/memory/huge_vector.h"
#include "verify/trace/kernel/tree64_view.h"

namespace svdag {

class Tree64 {
 public:
  // What the tree of `dag` takes. Looks at every second level of it.
  static uint64_t bytes(const DagView& dag);

  Tree64() = default;  // of nothing
  explicit Tree64(const DagView& dag);
  Tree64(Tree64&&) = default;  // no copies: the view looks at these words
  Tree64& operator=(Tree64&&) = default;
  const Tree64View& view() const { return view_; }
  uint64_t bytes() const { return words_.size() * sizeof(uint64_t); }

 private:
  class Maker;
  friend Tree64 tree_if_it_pays(const DagView& dag, uint64_t rays, uint64_t memory);
  Tree64(const DagView& dag, uint64_t bytes);

  HugeVector<uint64_t> words_;
  Tree64View view_;
};

// The tree, or the one of nothing where it does not pay: for fewer than some `rays` (each thread's)
// per node, where making it takes more than `memory` bytes, or without AVX2.
Tree64 tree_if_it_pays(const DagView& dag, uint64_t rays, uint64_t memory);

}  // namespace svdag
