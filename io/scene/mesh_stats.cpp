#include "io/scene/mesh_stats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "io/scene/polygons/collinear.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using Position = std::array<float, 3>;
using Face = std::array<uint32_t, 3>;

constexpr double kLargeCoordinate = 1e5;

// Offset and step with which positions are compared.
struct Frame {
  Point centre{0};  // subtracted
  Point step{0};    // rounding step of each axis, 0: none; see step_of()
};

// The last bit of a float as large as `value`.
double last_bit(double value) {
  return std::isnormal(value) ? std::ldexp(1.0, std::max(std::ilogb(value) - 23, -1022)) : 0;
}

// Double arithmetic separates vertices that were equal as floats, by 2^-53 of the largest
// coordinate. This step joins them again, but no two floats that differ, however near to 0.
double step_of(double side, double largest) {
  return std::min(last_bit(side), last_bit(largest));
}

// The centre is the rounded mean of all corners if a coordinate is large, and on each axis where
// all are far from 0 compared with their extent.
Frame find_frame(const Scene& scene) {
  Point sum{0};
  Box box;
  uint64_t corners = 0;
  scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles) {
      for (const Point& p : t.v) {
        sum += p;
        box.add(p);
      }
    }
    corners += 3 * batch.triangles.size();
  });
  const Point extent = box.max - box.min;
  Point largest;
  for (int a = 0; a < 3; ++a) largest[a] = std::max(std::abs(box.min[a]), std::abs(box.max[a]));
  const bool large = std::max({largest.x, largest.y, largest.z}) > kLargeCoordinate;
  Frame frame;
  for (int a = 0; a < 3; ++a) {
    if (large || largest[a] / 2 > extent[a])
      frame.centre[a] = std::nearbyint(sum[a] / double(corners));
    if (!large) frame.step[a] = step_of(std::max({extent.x, extent.y, extent.z}), largest[a]);
  }
  return frame;
}

Position round_position(const Point& p, const Frame& frame) {
  Position r;
  for (int c = 0; c < 3; ++c) {
    double value = p[c] - frame.centre[c];
    if (std::abs(value) > double(std::numeric_limits<float>::max())) {
      throw Error(ExitCode::kBadInput, "the mesh diagnostics cannot take coordinates above 3e38");
    }
    if (frame.centre[c] != 0 && frame.step[c] > 0)
      value = std::nearbyint(value / frame.step[c]) * frame.step[c];
    r[size_t(c)] = float(value) + 0.0f;  // -0 becomes 0
  }
  return r;
}

// The sorted set of positions of any number of corners: whenever the array is full, repeats are
// removed, and it grows only if more than half of it was new.
class PositionSet {
 public:
  explicit PositionSet(MemoryBudget* budget) : memory_(budget->reserve(0, "mesh positions")) {
    grow(size_t(1) << 16);
  }

  void add(const Position& p) {
    if (positions_.size() == capacity_) {
      compact();
      if (positions_.size() > capacity_ / 2) grow(2 * capacity_);
    }
    positions_.push_back(p);
  }

  void compact() {
    std::sort(positions_.begin(), positions_.end());
    positions_.erase(std::unique(positions_.begin(), positions_.end()), positions_.end());
  }

  size_t size() const { return positions_.size(); }
  uint32_t id(const Position& p) const {
    return uint32_t(std::lower_bound(positions_.begin(), positions_.end(), p) - positions_.begin());
  }

 private:
  void grow(size_t capacity) {
    // While the array grows, old and new exist at once.
    memory_.resize((capacity_ + capacity) * sizeof(Position), "mesh positions");
    positions_.reserve(capacity);
    capacity_ = capacity;
    memory_.resize(capacity_ * sizeof(Position), "mesh positions");
  }

  MemoryBudget::Reservation memory_;
  std::vector<Position> positions_;
  size_t capacity_ = 0;
};

// Union-find with path halving.
class Components {
 public:
  explicit Components(size_t n) : parent_(n), count_(n) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  uint32_t root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  uint64_t count() const { return count_; }

 private:
  std::vector<uint32_t> parent_;
  uint64_t count_;
};

// Calls use(length) for every run of equal elements of a sorted array.
template <class T, class Use>
void for_each_run(const std::vector<T>& sorted, const Use& use) {
  for (size_t i = 0, end = 0; i < sorted.size(); i = end) {
    for (end = i; end < sorted.size() && sorted[end] == sorted[i];) ++end;
    use(end - i);
  }
}

void count_edges(const std::vector<Face>& faces, MemoryBudget* budget, MeshStats* stats) {
  const auto memory = budget->reserve(faces.size() * 3 * sizeof(uint64_t), "mesh edges");
  std::vector<uint64_t> edges;
  edges.reserve(faces.size() * 3);
  for (const Face& f : faces) {  // corners ascend, so each edge has one key
    edges.push_back(uint64_t(f[0]) << 32 | f[1]);
    edges.push_back(uint64_t(f[1]) << 32 | f[2]);
    edges.push_back(uint64_t(f[0]) << 32 | f[2]);
  }
  std::sort(edges.begin(), edges.end());
  for_each_run(edges, [&](size_t uses) {
    stats->open_edges += uses == 1;
    stats->non_manifold_edges += uses > 2;
  });
}

// Second pass over the triangles, with numbered positions: properties of single triangles.
std::vector<Face> number_faces(const Scene& scene, const Frame& frame, const PositionSet& set,
                               Components* components, MeshStats* stats) {
  std::vector<Face> faces;
  faces.reserve(stats->triangles);
  scene.stream([&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles) {
      std::array<Position, 3> p;
      Face f;
      for (size_t i = 0; i < 3; ++i) {
        p[i] = round_position(t.v[i], frame);
        f[i] = set.id(p[i]);
      }
      components->join(f[0], f[1]);
      components->join(f[0], f[2]);
      stats->zero_area += collinear(p[0], p[1], p[2]);
      std::sort(f.begin(), f.end());
      if (f[0] == f[1] || f[1] == f[2]) {
        ++stats->repeated;
      } else {
        faces.push_back(f);
      }
    }
  });
  return faces;
}

}  // namespace

MeshStats compute_mesh_stats(const Scene& scene, MemoryBudget* budget) {
  const Frame frame = find_frame(scene);
  PositionSet set(budget);
  MeshStats stats;
  stats.triangles = scene
                        .stream([&](const TriangleBatch& batch) {
                          for (const Triangle& t : batch.triangles) {
                            for (const Point& p : t.v) set.add(round_position(p, frame));
                          }
                        })
                        .triangles;
  set.compact();
  stats.positions = set.size();
  if (set.size() > UINT32_MAX) {
    throw Error(ExitCode::kBadInput, "the mesh diagnostics cannot number over 2^32 positions");
  }
  const auto memory =
      budget->reserve(stats.triangles * sizeof(Face) + set.size() * sizeof(uint32_t), "mesh faces");
  Components components(set.size());
  std::vector<Face> faces = number_faces(scene, frame, set, &components, &stats);
  stats.components = components.count();
  std::sort(faces.begin(), faces.end());
  for_each_run(faces, [&](size_t copies) { stats.duplicates += copies - 1; });
  count_edges(faces, budget, &stats);
  return stats;
}

}  // namespace svdag
