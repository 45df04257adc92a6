#include "io/formats/dags/hashdag.h"

#include <array>
#include <cstring>

#include "io/formats/graph_window.h"
#include "io/formats/output.h"
#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

constexpr const char* kNameEnding = ".basic_dag.dag.bin";
constexpr int kMaxHashDagLevels = 17;  // 128K: the limit of the programs
constexpr uint64_t kHeaderBytes = 60;

class HashDagGraph : public NodeGraph {
 public:
  explicit HashDagGraph(const File& file) : nodes_(file), bricks_(file) {
    ByteStream header(file, 0, kHeaderBytes);
    for (double& side : box_) side = header_value<double>(&header);
    levels_ = int(checked_levels(file, header_value<uint32_t>(&header), 48));
    words_ = header_value<uint64_t>(&header);
    if (words_ == 0 || words_ > kNoChild || file.size() != kHeaderBytes + 4 * words_)
      fail_input(file.path(), "is not a HashDAG file: its size does not match its header", 52);
    grid_ = grid_of_box(file, {box_[0], box_[1], box_[2]}, {box_[3], box_[4], box_[5]}, levels_);
  }

  Grid grid() const override { return grid_; }

  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    const uint64_t at = offset(level, id, 1);
    const uint32_t mask = nodes_.u32(at) & 0xffU;
    offset(level, id, 1 + uint64_t(popcount8(mask)));
    std::array<uint32_t, 8> result;
    for (unsigned c = 0, next = 1; c < 8; ++c) {
      result[c] = kNoChild;
      if ((mask >> c & 1) == 0) continue;
      result[c] = nodes_.u32(at + 4 * next);
      if (result[c] >= words_)
        fail_input(nodes_.path(), "damaged file: a child pointer is out of range", at + 4 * next);
      ++next;
    }
    return result;
  }
  Brick brick(uint32_t id) override { return bricks_.u64(offset(levels_ - 2, id, 2)); }

 private:
  // File offset of node `id`, which takes `words` words.
  uint64_t offset(int level, uint32_t id, uint64_t words) const {
    const uint64_t at = kHeaderBytes + 4 * uint64_t(id);
    if (id + words > words_)
      fail_input(nodes_.path(),
                 "damaged file: a node of level " + std::to_string(level) + " is truncated", at);
    return at;
  }

  GraphWindow nodes_, bricks_;
  std::array<double, 6> box_;
  int levels_;
  uint64_t words_;
  Grid grid_;
};

// The programs take the number of levels from the file name: any grid in a file named "64k" would
// be read as 64K^3.
void check_resolution_in_name(const std::string& path, int levels) {
  const std::string name = path.substr(0, path.size() - std::strlen(kNameEnding));
  if (!name.ends_with('k')) return;
  const size_t begin = name.find_last_not_of("0123456789", name.size() - 2) + 1;
  const std::string number = name.substr(begin, name.size() - 1 - begin);
  const std::string own = levels < 10 ? "" : std::to_string(uint64_t(1) << (levels - 10));
  if (!number.empty() && number != own)
    fail_usage(path + ": the name says " + number + "K^3, but the grid has " +
               format_resolution(uint64_t(1) << levels) + "^3: rename the output");
}

std::string strip_ending(const std::string& path, const std::string& ending) {
  return path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
}

}  // namespace

std::string hashdag_path(const std::string& path, int levels) {
  if (path.ends_with(kNameEnding)) {
    check_resolution_in_name(path, levels);
    return path;
  }
  if (levels < 10)
    fail_usage(path +
               ": HashDAG defines no name for grids below 1K^3: give the full name, ending in " +
               kNameEnding);
  return strip_ending(path, ".dag.bin") + std::to_string(uint64_t(1) << (levels - 10)) + "k" +
         kNameEnding;
}

void write_hashdag(const LevelDag& dag, const Grid& grid, const std::string& path) {
  if (grid.levels > kMaxHashDagLevels)
    fail_usage("HashDAG holds grids up to 128K^3, this one has " +
               format_resolution(uint64_t(grid.resolution())) + "^3: export a coarser --level");
  std::array<uint64_t, kMaxSections> base{};  // [level]: index of its first word
  for (uint32_t k = 0; k < dag.brick_level(); ++k) base[k + 1] = base[k] + dag.words(k);
  const uint64_t words = base[dag.brick_level()] + 2 * dag.bricks();
  if (words >= kNoChild)
    fail_usage("HashDAG holds at most 2^32 - 2 words, this DAG needs " + format_count(words) +
               ": export a coarser --level");
  Output out(path);
  const Point corner = grid.corner();
  for (int a = 0; a < 3; ++a) out.put(corner[a]);
  for (int a = 0; a < 3; ++a) out.put(corner[a] + double(grid.resolution()) * grid.voxel_size);
  out.put(uint32_t(grid.levels));
  out.put(words);
  for (uint32_t k = 0; k < dag.brick_level(); ++k) {
    const uint32_t below = uint32_t(base[k + 1]);
    const bool to_bricks = k + 1 == dag.brick_level();
    dag.for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      out.put(mask);
      for (int i = 0; i < popcount8(mask); ++i)
        out.put(below + (to_bricks ? 2 * dag.brick_number(children[i]) : children[i]));
    });
  }
  dag.for_each_brick([&](Brick brick) { out.put(brick); });
  out.commit();
}

std::unique_ptr<NodeGraph> read_hashdag(const File& file) {
  return std::make_unique<HashDagGraph>(file);
}

}  // namespace svdag
