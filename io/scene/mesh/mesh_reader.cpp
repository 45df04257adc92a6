#include "io/scene/mesh/mesh_reader.h"

#include <fnmatch.h>

#include <algorithm>

namespace svdag {
namespace {

// *use: the patterns that match this or an earlier name; null: not recorded.
bool matches_any(const std::vector<std::string>& patterns, const std::string& name,
                 std::vector<bool>* use) {
  bool any = false;
  for (size_t i = 0; i < patterns.size() && !(any && use == nullptr); ++i) {
    if (fnmatch(patterns[i].c_str(), name.c_str(), 0) != 0) continue;
    any = true;
    if (use != nullptr) (*use)[i] = true;
  }
  return any;
}

}  // namespace

bool NameFilter::excludes(const std::string& name) const {
  return matches_any(exclude, name, use == nullptr ? nullptr : &use->exclude);
}

bool NameFilter::includes(const std::string& name) const {
  return include.empty() || matches_any(include, name, use == nullptr ? nullptr : &use->include);
}

void BatchWriter::mesh(std::string_view name, bool undeformed) {
  flush();
  mesh_ = name;
  undeformed_ = undeformed;
  first_ = 0;
}

void BatchWriter::quantisation(double step) {
  if (step == quantisation_) return;
  flush();
  quantisation_ = step;
}

// All batches but the last of a mesh are full; the memory grows until the first one is.
void BatchWriter::make_room() {
  if (room_ == kBatch) return flush();
  auto larger = std::make_unique_for_overwrite<Triangle[]>(kBatch);
  std::copy_n(batch_.get(), size_, larger.get());
  batch_ = std::move(larger);
  room_ = kBatch;
}

void BatchWriter::flush() {
  if (size_ == 0) return;
  sink_({mesh_, first_, {batch_.get(), size_}, quantisation_, undeformed_});
  first_ += size_;
  size_ = 0;
}

}  // namespace svdag
