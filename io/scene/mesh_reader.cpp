#include "io/scene/mesh_reader.h"

#include <fnmatch.h>

#include <algorithm>

namespace svdag {
namespace {

bool matches_any(const std::vector<std::string>& patterns, const std::string& name) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

}  // namespace

bool NameFilter::excludes(const std::string& name) const {
  return matches_any(exclude, name);
}

bool NameFilter::includes(const std::string& name) const {
  return include.empty() || matches_any(include, name);
}

void BatchWriter::mesh(std::string_view name) {
  flush();
  mesh_ = name;
  first_ = 0;
}

void BatchWriter::quantisation(double step) {
  if (step == quantisation_) return;
  flush();
  quantisation_ = step;
}

// Batches are full but for the last of a mesh: until then the memory grows.
void BatchWriter::make_room() {
  if (room_ == kBatch) return flush();
  auto larger = std::make_unique_for_overwrite<Triangle[]>(kBatch);
  std::copy_n(batch_.get(), size_, larger.get());
  batch_ = std::move(larger);
  room_ = kBatch;
}

void BatchWriter::flush() {
  if (size_ == 0) return;
  sink_({mesh_, first_, {batch_.get(), size_}, quantisation_});
  first_ += size_;
  size_ = 0;
}

}  // namespace svdag
