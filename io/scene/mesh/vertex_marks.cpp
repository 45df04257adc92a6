#include "io/scene/mesh/vertex_marks.h"

#include <cmath>

namespace svdag {
namespace {

// A box that records whether the order of its points can matter.
class CertainBox {
 public:
  void add(const Point& p) {
    box_.add(p);
    for (int a = 0; a < 3; ++a) {
      finite_ = finite_ && std::isfinite(p[a]);
      if (p[a] == 0) zeros_[a] |= std::signbit(p[a]) ? 2 : 1;
    }
  }
  bool certain() const {
    for (int a = 0; a < 3; ++a) {
      if (zeros_[a] == 3 && (box_.min[a] == 0 || box_.max[a] == 0)) return false;
    }
    return finite_;
  }
  const Box& box() const { return box_; }

 private:
  Box box_;
  bool finite_ = true;
  int zeros_[3] = {0, 0, 0};  // 1: a zero was seen, 2: a negative one
};

}  // namespace

bool VertexMarks::make(size_t chunk) {
  constexpr uint64_t bytes = kChunk / 8;
  full_ = full_ || memory_.bytes() + bytes > max_bytes_;
  if (full_) return false;
  memory_.resize(memory_.bytes() + bytes, kPurpose);
  if (chunk >= chunks_.size()) chunks_.resize(chunk + 1);
  chunks_[chunk] = std::make_unique<uint64_t[]>(kChunk / 64);
  return true;
}

std::optional<Box> VertexMarks::box(VertexPages* positions) const {
  if (full_) return {};
  CertainBox box;
  positions->visit([&](uint64_t i, const Point& p) {
    if (marked(i)) box.add(p);
  });
  if (!box.certain()) return {};
  return box.box();
}

}  // namespace svdag
