#include "verify/integrity/integrity.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "io/dag/colours/colour_writer.h"
#include "io/dag/compact/compact_writer.h"
#include "io/dag/graph/select.h"
#include "io/dag/write/node_starts.h"
#include "io/grid.h"
#include "streaming/printable.h"
#include "verify/integrity/union_check.h"

namespace svdag {
namespace {

using Key = std::array<uint64_t, 8>;

// Checks the levels one after the other, bricks first; `below_*` describes the level below.
class Inspection {
 public:
  Inspection(const Header& header, const DagView& dag, const LayerTable& layers,
             IntegrityReport* report)
      : header_(header), dag_(dag), layers_(layers), report_(report) {
    report_->nodes.assign(dag.brick_level() + 1, 0);
  }

  void run() {
    check_bricks();
    for (uint32_t level = dag_.brick_level(); level-- > 0;) check_nodes(level);
    const uint64_t roots = report_->nodes[0];
    if (layers_.empty() && roots != (dag_.brick_count == 0 ? 0U : 1U))
      report_->defects.push_back("level 0 has " + std::to_string(roots) + " nodes instead of one");
    for (const Layer& layer : layers_.layers) {
      const uint64_t found = layer.root < below_voxels_.size() ? below_voxels_[layer.root] : 0;
      if (found != layer.voxels)
        report_->defects.push_back("layer \"" + printable(layer.name) + "\" has " +
                                   std::to_string(found) + " voxels, its table says " +
                                   std::to_string(layer.voxels));
    }
    report_->voxels = below_voxels_.empty() ? 0 : below_voxels_[0];
    for (uint32_t level = 0; level <= dag_.brick_level(); ++level) {
      if (header_.sections[level].nodes != report_->nodes[level])
        defect(level, "has " + std::to_string(report_->nodes[level]) + " nodes, its header says " +
                          std::to_string(header_.sections[level].nodes));
    }
  }

 private:
  void defect(uint32_t level, const std::string& what) {
    report_->defects.push_back("level " + std::to_string(level) + " " + what);
  }

  void check_bricks() {
    const uint32_t level = dag_.brick_level();
    report_->nodes[level] = dag_.brick_count;
    below_voxels_.resize(dag_.brick_count);
    uint64_t unordered = 0, last = 0;
    for (uint64_t i = 0; i < dag_.brick_count; ++i) {
      const uint64_t brick = dag_.bricks[i];
      if (brick <= last) ++unordered;  // `last` is 0 first, so an empty brick is never in order
      last = brick;
      below_voxels_[i] = uint64_t(std::popcount(brick));
    }
    if (unordered > 0)
      defect(level, "has " + std::to_string(unordered) +
                        " bricks that are empty, repeated or out of order");
  }

  void check_nodes(uint32_t level) {
    const uint32_t* words = dag_.words[level];
    const uint64_t count = dag_.index_end[level];
    RankBitmap starts = node_starts(dag_, level, &budget_);
    std::vector<uint64_t> voxels(starts.count());
    std::vector<uint64_t> used((below_voxels_.size() + 63) / 64);
    uint64_t unordered = 0, empty = 0, invalid = 0, node = 0;
    Key last{}, first{};
    for (uint64_t w = 0; w < count; ++node) {
      const uint32_t mask = words[w];
      const uint64_t size = 1 + uint64_t(std::popcount(mask & 0xffU));
      if (mask == 0 || mask > 0xffU) ++empty;
      // The second pass finds more nodes than the first if the mapped file was overwritten.
      if (w + size > count || node == voxels.size()) {
        defect(level, "ends within a node");
        break;
      }
      Key key{};
      const uint32_t* child = words + w + 1;
      for (unsigned c = 0; c < 8; ++c) {
        if ((mask >> c & 1U) == 0) continue;
        key[c] = uint64_t(*child) + 1;
        if (!visit_child(level, *child++, &voxels[node], &used)) ++invalid;
      }
      // Key{} is the empty node, below every other. Of several roots, the first is in no order.
      if (!(last < key) || (node > 0 && key == first)) ++unordered;
      if (node > 0 || layers_.empty() || level > 0) last = key;
      if (node == 0 && level == 0) first = key;
      w += size;
    }
    report_->nodes[level] = starts.count();
    report(level, unordered, empty, invalid, used);
    below_voxels_ = std::move(voxels);
    below_ = std::move(starts);
  }

  // Adds a child's voxels and marks it as used; returns false if no node begins there.
  bool visit_child(uint32_t level, uint32_t child, uint64_t* voxels, std::vector<uint64_t>* used) {
    const bool to_brick = level + 1 == dag_.brick_level();
    if (to_brick ? child >= dag_.brick_count : !below_.has(child)) return false;
    const uint64_t rank = to_brick ? child : below_.rank(child);
    *voxels += below_voxels_[rank];
    (*used)[rank / 64] |= uint64_t(1) << (rank % 64);
    return true;
  }

  void report(uint32_t level, uint64_t unordered, uint64_t empty, uint64_t invalid,
              const std::vector<uint64_t>& used) {
    if (empty > 0) defect(level, "has " + std::to_string(empty) + " impossible child masks");
    if (unordered > 0)
      defect(level,
             "has " + std::to_string(unordered) + " nodes that are repeated or out of order");
    if (invalid > 0)
      defect(level,
             "has " + std::to_string(invalid) + " child pointers to words where no node begins");
    uint64_t marked = 0;
    for (const uint64_t bits : used) marked += uint64_t(std::popcount(bits));
    if (marked < below_voxels_.size())
      defect(level + 1, "has " + std::to_string(below_voxels_.size() - marked) +
                            " nodes that no node uses, so the DAG is not minimal");
  }

  const Header& header_;
  const DagView& dag_;
  const LayerTable& layers_;
  IntegrityReport* report_;
  std::vector<uint64_t> below_voxels_;  // per node of the level below
  MemoryBudget budget_;
  RankBitmap below_{&budget_, ""};  // the nodes of the level below, unless those are bricks
};

// Searches for a voxel outside the selection.
//
// Descends only into cubes that the border of the selection cuts, and once per node and pattern
// of cut borders: a floor in the border's plane has few nodes, but an enormous number of cubes.
class OutsideSearch {
 public:
  explicit OutsideSearch(const DagView& dag) : dag_(dag), searched_(dag.levels) {}

  bool find(const Header& h, uint32_t root) {
    VoxelBox selection;
    for (int a = 0; a < 3; ++a) {
      selection.min[a] = h.selection_min[a];
      selection.max[a] = h.selection_max[a];
    }
    return find(0, root, selection);
  }

 private:
  // Returns true if a voxel is found. `selection` is relative to the corner of the node's cube. No
  // node is empty.
  bool find(uint32_t level, uint32_t node, const VoxelBox& selection) {
    const int64_t side = int64_t(1) << (dag_.levels - level);
    const VoxelBox cut = clipped(selection, side);
    if (cut.empty()) return true;
    if (cut == VoxelBox{LatticePoint(0), LatticePoint(side)}) return false;
    if (level == dag_.brick_level()) return find_in_brick(dag_.bricks[node], cut);
    uint64_t& searched = searched_[level][node];
    const uint64_t cut_bit = uint64_t(1) << borders_inside(cut, side);
    if ((searched & cut_bit) != 0) return false;  // already searched without a find
    searched |= cut_bit;
    for (unsigned c = 0; c < 8; ++c) {
      const uint32_t child = dag_child(dag_, level, node, c);
      const LatticePoint corner = LatticePoint(c >> 2, c >> 1 & 1, c & 1) * (side / 2);
      if (child != kNoChild && find(level + 1, child, {cut.min - corner, cut.max - corner}))
        return true;
    }
    return false;
  }

  // The borders of the selection (six bits) that run through the inside of a cube. They do so at
  // the same position in all cubes of a level, because cubes begin at multiples of their side.
  static unsigned borders_inside(const VoxelBox& cut, int64_t side) {
    unsigned bits = 0;
    for (int a = 0; a < 3; ++a) {
      bits |= unsigned(cut.min[a] != 0) << 2 * a;
      bits |= unsigned(cut.max[a] != side) << (2 * a + 1);
    }
    return bits;
  }

  static bool find_in_brick(uint64_t brick, const VoxelBox& selection) {
    for (; brick != 0; brick &= brick - 1) {
      const unsigned bit = unsigned(std::countr_zero(brick));
      const LatticePoint voxel((bit >> 5 & 1) * 2 + (bit >> 2 & 1),
                               (bit >> 4 & 1) * 2 + (bit >> 1 & 1), (bit >> 3 & 1) * 2 + (bit & 1));
      if (!selection.holds({voxel, voxel + int64_t(1)})) return true;
    }
    return false;
  }

  // The part of `box` in the cube of this side at 0.
  static VoxelBox clipped(const VoxelBox& box, int64_t side) {
    VoxelBox part;
    for (int a = 0; a < 3; ++a) {
      part.min[a] = std::clamp<int64_t>(box.min[a], 0, side);
      part.max[a] = std::clamp<int64_t>(box.max[a], 0, side);
    }
    return part;
  }

  const DagView& dag_;
  // [level], per node: the patterns of cut borders already searched, one bit for each of the 2^6.
  std::vector<std::unordered_map<uint32_t, uint64_t>> searched_;
};

// Checks what the roots reach. Descending is only safe in a DAG whose pointers are valid.
void check_roots(const Header& header, const DagView& dag, const LayerTable& layers,
                 std::vector<std::string>* defects) {
  std::vector<uint32_t> roots;  // [number]: the index
  for (uint64_t index = 0; index < dag.index_end[0]; index = dag_next(dag, 0, index))
    roots.push_back(uint32_t(index));
  if (roots.empty()) return;
  // The union of a solid rule is the solid of all triangles, which follows from no layer.
  const bool has_or = !layers.empty() && layers.has_union && !is_solid(Rule(header.rule));
  if (has_or) {
    std::vector<uint32_t> of_layers;
    for (const Layer& layer : layers.layers) {
      if (layer.root != kNoRoot) of_layers.push_back(roots[layer.root]);
    }
    const std::optional<bool> holds = is_union_of(dag, roots[0], std::move(of_layers));
    if (!holds)
      defects->push_back("the union is not proved: its layers meet in too many ways");
    else if (!*holds)
      defects->push_back("the union is not exactly the voxels of the layers");
  }
  if (header.bounded == 0) return;
  OutsideSearch search(dag);
  const size_t searched = has_or ? 1 : roots.size();
  if (std::any_of(roots.begin(), roots.begin() + std::ptrdiff_t(searched),
                  [&](uint32_t root) { return search.find(header, root); }))
    defects->push_back("a voxel outside the selection is set");
}

// Checks the corner's lattice plane k0, a multiple of corner_step(). A box has no such planes.
void check_lattice(const Header& header, std::vector<std::string>* defects) {
  const bool lattice = header.grid_kind != uint32_t(Grid::Kind::kBox);
  const int64_t step = corner_step(int(header.levels));
  for (const int64_t k0 : header.k0) {
    if (lattice && k0 % step != 0)
      defects->push_back("the lattice plane k0 of the grid's corner is " + std::to_string(k0) +
                         ", not a multiple of " + std::to_string(step));
    if (!lattice && k0 != 0)
      defects->push_back("the grid is a box, but has a lattice plane k0 = " + std::to_string(k0));
  }
  const Point corner = grid_of(header).corner();
  for (int a = 0; lattice && a < 3; ++a) {
    if (header.corner[a] != corner[a])
      defects->push_back("the grid's corner is not at the lattice plane k0");
  }
}

}  // namespace

IntegrityReport inspect(const Header& header, const DagView& dag, std::string_view metadata,
                        const LayerTable& layers) {
  IntegrityReport report;
  Inspection(header, dag, layers, &report).run();
  if (report.defects.empty()) check_roots(header, dag, layers, &report.defects);
  if (report.voxels != header.voxels)
    report.defects.push_back("the header counts " + std::to_string(header.voxels) +
                             " voxels, the DAG holds " + std::to_string(report.voxels));
  check_lattice(header, &report.defects);
  // A move is at most half a lattice step, including the rounding of the move itself.
  if (!(header.largest_snap >= 0 && header.largest_snap <= std::ldexp(0.5, -int(header.fraction))))
    report.defects.push_back("the largest snap is more than half a lattice step");
  for (std::string& defect : metadata_defects(header, metadata))
    report.defects.push_back(std::move(defect));
  return report;
}

IntegrityReport inspect_file(const DagFile& file, const WorkRoom& room) {
  if (file.has_colours()) {
    IntegrityReport report = inspect_file(without_colours(file, room.folder), room);
    for (auto defects :
         {metadata_defects(file.header(), file.metadata()), colour_defects(file, room.budget)})
      report.defects.insert(report.defects.end(), defects.begin(), defects.end());
    return report;
  }
  std::optional<DagFile> converted;
  if (file.layout() != Layout::kPlain) converted.emplace(derive(file, {}, room));
  const DagFile& plain = converted ? *converted : file;
  IntegrityReport report = inspect(plain.header(), plain.view(), plain.metadata(), plain.layers());
  if (converted && !is_compact_form(file, plain, room))
    report.defects.push_back("the bytes differ from the compact layout of these nodes");
  return report;
}

}  // namespace svdag
