// A 64-tree in memory, built from a DAG, for tracing many rays.
//
// It takes two to three times the memory of the file, on huge pages, and a third to half a
// microsecond per node of the DAG to build. Nodes are in depth-first order, so that the nodes that
// a ray meets are close together. It pays off for many rays per node of the DAG; otherwise the
// mapped file is traced, with the same hits.
#pragma once

#include <vector>

#include "streaming/memory/huge_vector.h"
#include "verify/trace/kernel/tree64_view.h"

namespace svdag {

class Tree64 {
 public:
  // Size of the tree of `dag`. Reads every second level of the DAG.
  static uint64_t bytes(const DagView& dag);

  Tree64() = default;  // empty
  explicit Tree64(const DagView& dag);
  Tree64(Tree64&&) = default;  // not copyable: view_ points into words_
  Tree64& operator=(Tree64&&) = default;
  const Tree64View& view() const { return view_; }
  uint64_t bytes() const { return words_.size() * sizeof(uint64_t); }

 private:
  class Builder;
  friend Tree64 tree_if_it_pays(const DagView& dag, uint64_t rays, uint64_t memory);
  Tree64(const DagView& dag, uint64_t bytes);

  HugeVector<uint64_t> words_;
  Tree64View view_;
};

// Builds the tree if it pays off, else returns an empty one: if there are few `rays` (of each
// thread) per node, if building takes more than `memory` bytes, or without AVX2.
Tree64 tree_if_it_pays(const DagView& dag, uint64_t rays, uint64_t memory);

}  // namespace svdag
