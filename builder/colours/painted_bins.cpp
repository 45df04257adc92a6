#include "builder/colours/painted_bins.h"

#include <cstring>
#include <span>

#include "builder/octree/morton.h"
#include "builder/overlap/overlap.h"
#include "streaming/error.h"

namespace svdag {

PaintedBins::PaintedBins(int levels, const Cube& parent, int depth, Scratch* scratch)
    : levels_(levels),
      parent_(parent),
      depth_(depth),
      scratch_(scratch),
      bins_(size_t(1) << (3 * depth)) {
  SVDAG_ASSERT(depth >= 1 && depth <= kMaxDepth && parent.level + depth <= levels);
}

void PaintedBins::add(const PaintedTriangle& t) {
  deal(t, make_setup(t.triangle()), parent_);
}

void PaintedBins::deal(const PaintedTriangle& t, const TriangleSetup& setup, const Cube& cube) {
  if (cube.level == parent_.level + depth_) return append(cube, t);
  const ListedTriangle entry{&setup, setup.edges};
  const int64_t side = int64_t(1) << cube.side_log2(levels_);
  const ChildOverlap overlap = overlap_children(entry, cube.corner(levels_), side);
  for (unsigned c = 0; c < 8; ++c) {
    if (overlap.touched >> c & 1) deal(t, setup, cube.child(c));
  }
}

void PaintedBins::append(const Cube& cube, const PaintedTriangle& t) {
  OpenBin& bin = bins_[morton(cube.coordinate) % bins_.size()];
  if (!bin.writer)
    bin.writer.emplace(scratch_->transient(), scratch_->new_streams(), scratch_->budget());
  const auto put = [&](const auto& value) {
    bin.writer->append(std::as_bytes(std::span(&value, 1)));
  };
  put(t.paint);
  for (const PaintedTriangle::Corner& corner : t.corners) {
    put(corner.position);
    if (t.has_one_colour()) continue;
    put(corner.texture);
    put(corner.colour);
  }
  if (t.has_one_colour()) put(t.corners[0].colour);
  ++bin.triangles;
}

std::vector<PaintedBin> PaintedBins::finish() {
  std::vector<PaintedBin> bins;
  const uint64_t first = morton(parent_.coordinate) * bins_.size();
  for (uint64_t i = 0; i < bins_.size(); ++i) {
    OpenBin& bin = bins_[i];
    if (!bin.writer) continue;
    bins.push_back(
        {{parent_.level + depth_, unmorton(first + i)}, bin.triangles, bin.writer->finish()});
    bin.writer.reset();
  }
  return bins;
}

template <class Value>
void PaintedReader::get(Value* value) {
  auto* out = reinterpret_cast<std::byte*>(value);
  for (size_t left = sizeof *value; left > 0;) {
    if (block_.empty()) block_ = reader_.next();
    if (block_.empty()) reader_.fail_damaged();
    const size_t n = std::min(left, block_.size());
    std::memcpy(out, block_.data(), n);
    block_ = block_.subspan(n);
    out += n;
    left -= n;
  }
}

bool PaintedReader::read(PaintedTriangle* t) {
  if (left_ == 0) return false;
  --left_;
  *t = {};
  get(&t->paint);
  for (PaintedTriangle::Corner& corner : t->corners) {
    get(&corner.position);
    if (t->has_one_colour()) continue;
    get(&corner.texture);
    get(&corner.colour);
  }
  if (t->has_one_colour()) get(&t->corners[0].colour);
  return true;
}

}  // namespace svdag
