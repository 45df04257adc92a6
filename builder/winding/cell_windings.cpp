#include "builder/winding/cell_windings.h"

#include <algorithm>
#include <tuple>

#include "io/dag/format.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr size_t kMinChanges = 1 << 14;

constexpr auto kBySubject = [](const CellWindings::Entry& e) {
  return std::tuple(e.subject, e.point);
};
constexpr auto kByPoint = [](const CellWindings::Entry& e) {
  return std::tuple(e.point, e.subject);
};

}  // namespace

int CellWindings::level_of_grid(int levels) {
  return std::min(levels - 2, WindingLines::kMaxSideLog2);
}

CellWindings::CellWindings(int levels, const Cube& root, int level, MemoryBudget* budget)
    : lines_(levels, root, level), budget_(budget) {
  if (budget_ != nullptr) reservation_ = budget_->reserve(0, "winding numbers");
}

void CellWindings::add(const LatticeTriangle& triangle, size_t point, int change) {
  if (entries_.size() + 2 > entries_.capacity()) compact();
  if ((triangle.sheet & kSheetOfUnion) == 0)
    entries_.push_back({uint32_t(point), kUnionSet, change});
  if (triangle.subject != kUnionSet && (triangle.sheet & kSheetOfLayer) == 0)
    entries_.push_back({uint32_t(point), triangle.subject, change});
}

void CellWindings::add(const LatticeTriangle& triangle) {
  lines_.for_each_change(triangle, [&](size_t point, int change) { add(triangle, point, change); });
}

void CellWindings::add_with_ray(const LatticeTriangle& triangle) {
  if (const int change = lines_.ray_change(triangle); change != 0) add(triangle, 0, change);
  add(triangle);
}

// Joins the changes of one step, and doubles the memory if more than half of it is still in use.
void CellWindings::compact() {
  std::ranges::sort(entries_, {}, kBySubject);
  size_t kept = 0;
  for (const Entry& e : entries_) {
    if (kept > 0 && kBySubject(entries_[kept - 1]) == kBySubject(e)) {
      entries_[kept - 1].winding += e.winding;
    } else {
      entries_[kept++] = e;
    }
  }
  entries_.resize(kept);
  std::erase_if(entries_, [](const Entry& e) { return e.winding == 0; });
  const size_t needed = 2 * entries_.size() + 2;
  if (needed <= entries_.capacity()) return;
  const size_t capacity = std::max(kMinChanges, 2 * needed);
  if (budget_ != nullptr)  // both arrays exist during the copy
    reservation_.resize((entries_.capacity() + capacity) * sizeof(Entry), "winding numbers");
  entries_.reserve(capacity);
  if (budget_ != nullptr) reservation_.resize(capacity * sizeof(Entry), "winding numbers");
}

void CellWindings::finish(const LayerWindings& at_root) {
  for (const auto& [subject, winding] : at_root) {
    if (entries_.size() == entries_.capacity()) compact();
    entries_.push_back({0, subject, winding});
  }
  compact();
  const std::vector<Entry> changes = std::move(entries_);
  entries_ = {};
  const auto keep = [&](size_t point, Subject subject, int32_t winding) {
    if (winding == 0) return;
    if (entries_.size() == entries_.capacity() && budget_ != nullptr)
      reservation_.resize((changes.size() + 3 * entries_.size() + kMinChanges) * sizeof(Entry),
                          "winding numbers");
    entries_.push_back({uint32_t(point), subject, winding});
  };
  std::vector<int32_t> steps(lines_.points());
  for (auto begin = changes.begin(); begin != changes.end();) {
    const Subject subject = begin->subject;
    const auto end =
        std::find_if(begin, changes.end(), [&](const Entry& e) { return e.subject != subject; });
    // Most layers change only lines along z, each from one of its points to its end.
    if (std::none_of(begin, end, [&](const Entry& e) { return lines_.begins_line(e.point); })) {
      int32_t winding = 0;
      for (; begin != end; ++begin) {
        winding += begin->winding;
        size_t to = lines_.end_of_line(begin->point);
        const bool last = begin + 1 == end || (begin + 1)->point >= to;
        if (!last) to = (begin + 1)->point;
        for (size_t point = begin->point; point < to; ++point) keep(point, subject, winding);
        if (last) winding = 0;
      }
      continue;
    }
    std::ranges::fill(steps, 0);
    for (; begin != end; ++begin) steps[begin->point] = begin->winding;
    lines_.sum(steps);
    for (size_t point = 0; point < steps.size(); ++point) keep(point, subject, steps[point]);
  }
  std::ranges::sort(entries_, {}, kByPoint);
}

LayerWindings CellWindings::at(const Cube& cube) const {
  const size_t point = lines_.index(cube);
  LayerWindings windings;
  for (auto at = std::ranges::lower_bound(entries_, uint32_t(point), {}, &Entry::point);
       at != entries_.end() && at->point == point; ++at)
    windings.push_back({at->subject, at->winding});
  return windings;
}

bool CellWindings::are_of_grid(int levels, const std::vector<Entry>& entries) {
  const size_t points = size_t(1) << 3 * level_of_grid(levels);
  for (size_t i = 0; i < entries.size(); ++i) {
    const Entry& e = entries[i];
    if (e.point >= points || e.subject > kMaxLayers || e.winding == 0 ||
        (i > 0 && kByPoint(entries[i - 1]) >= kByPoint(e)))
      return false;
  }
  return true;
}

std::shared_ptr<const CellWindings> CellWindings::of_grid(int levels, std::vector<Entry> entries) {
  SVDAG_ASSERT(are_of_grid(levels, entries));
  const auto windings =
      std::make_shared<CellWindings>(levels, Cube(), level_of_grid(levels), nullptr);
  windings->entries_ = std::move(entries);
  return windings;
}

}  // namespace svdag
