#include "io/formats/dags/hashdag.h"

#include <array>
#include <cstring>

#include "io/formats/graph_window.h"
#include "io/formats/output.h"
#include "io/formats/voxel_colours.h"
#include "io/units.h"
#include "streaming/error.h"
#include "streaming/file/file.h"
#include "streaming/file/file_folder.h"

namespace svdag {
namespace {

constexpr const char* kNameEnding = ".basic_dag.dag.bin";
constexpr int kMaxHashDagLevels = 17;  // 128K: the limit of the programs
constexpr uint64_t kHeaderBytes = 60;
constexpr uint32_t kCountedLevels = 7;  // levels whose nodes always have less than 2^24 voxels

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

// Index of the first word of each level, and of the end. Errors: kUsage.
std::array<uint64_t, kMaxSections + 1> word_offsets(const WholeDag& dag) {
  const Grid grid = dag.grid();
  if (grid.levels > kMaxHashDagLevels)
    fail_usage("HashDAG holds grids up to 128K^3, this one has " +
               format_resolution(uint64_t(grid.resolution())) + "^3: export a coarser --level");
  std::array<uint64_t, kMaxSections + 1> base{};
  for (uint32_t k = 0; k < dag.brick_level(); ++k) base[k + 1] = base[k] + dag.words(k);
  const uint64_t words = base[dag.brick_level()] + 2 * dag.bricks().size();
  if (words >= kNoChild)
    fail_usage("HashDAG holds at most 2^32 - 2 words, this DAG needs " + format_count(words) +
               ": export a coarser --level");
  base[dag.brick_level() + 1] = words;
  return base;
}

// The voxels below each node.
struct Enclosed {
  uint32_t top_levels;
  MemoryBudget::Reservation memory;             // of `top`
  std::vector<uint64_t> top;                    // of the top levels, in the order of the file
  std::vector<WorkArray<uint32_t>> upper_bits;  // [level][word] of a mask
};

Enclosed count_enclosed(const WholeDag& dag, const WorkRoom& room) {
  constexpr uint64_t kMaxTop = uint64_t(1) << 24;
  Enclosed enclosed{std::max(dag.levels(), kCountedLevels + 1) - kCountedLevels, {}, {}, {}};
  uint64_t top = 0;
  for (uint32_t k = 0; k < enclosed.top_levels; ++k) top += dag.nodes(k);
  if (top > kMaxTop)
    fail_usage(
        "--colours: HashDAG counts voxels below at most 2^24 nodes of the upper levels, "
        "this DAG has " +
        format_count(top) + ": export a coarser --level");
  enclosed.memory = room.budget->reserve(top * sizeof(uint64_t), "voxels below nodes");
  enclosed.top.resize(top);
  enclosed.upper_bits.resize(dag.brick_level());
  WorkArray<uint64_t> below(dag.bricks().size(), room);
  uint64_t number = 0;
  for (const Brick brick : dag.bricks()) below[number++] = uint64_t(std::popcount(brick));
  for (uint32_t k = dag.brick_level(); k-- > 0;) {
    const bool is_top = k < enclosed.top_levels;
    WorkArray<uint64_t> here(dag.words(k), room);
    WorkArray<uint32_t> upper_bits(dag.words(k), room);
    if (is_top) top -= dag.nodes(k);
    uint64_t word = 0, next = top;
    dag.for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      for (int i = 0; i < popcount8(mask); ++i) here[word] += below[children[i]];
      upper_bits[word] = uint32_t(is_top ? next : here[word]);
      if (is_top) enclosed.top[next++] = here[word];
      word += 1 + uint64_t(popcount8(mask));
    });
    enclosed.upper_bits[k] = std::move(upper_bits);
    below = std::move(here);
  }
  return enclosed;
}

// `enclosed` is null without colours.
void put_dag(const WholeDag& dag, const std::array<uint64_t, kMaxSections + 1>& base,
             const Enclosed* enclosed, Output* out) {
  const Grid grid = dag.grid();
  const Point corner = grid.corner();
  for (int a = 0; a < 3; ++a) out->put(corner[a]);
  for (int a = 0; a < 3; ++a) out->put(corner[a] + double(grid.resolution()) * grid.voxel_size);
  out->put(uint32_t(grid.levels));
  out->put(base[dag.brick_level() + 1]);
  for (uint32_t k = 0; k < dag.brick_level(); ++k) {
    const uint32_t below = uint32_t(base[k + 1]);
    const bool to_bricks = k + 1 == dag.brick_level();
    uint64_t word = 0;
    dag.for_each_node(k, [&](uint32_t mask, const uint32_t* children) {
      out->put(enclosed == nullptr ? mask : mask | enclosed->upper_bits[k][word] << 8);
      for (int i = 0; i < popcount8(mask); ++i)
        out->put(below + (to_bricks ? 2U : 1U) * children[i]);
      word += 1 + uint64_t(popcount8(mask));
    });
  }
  for (const Brick brick : dag.bricks()) out->put(brick);
}

// Writes the colours of the voxels of a DAG, depth first.
class ColourWriter {
 public:
  ColourWriter(const DagView& dag, const VoxelColours& colours, Output* out)
      : dag_(dag), colours_(colours), out_(out) {}

  void put_below(uint32_t level, uint32_t node, const Voxel& corner) {
    if (level == dag_.brick_level()) {
      for (Brick bits = dag_.bricks[node]; bits != 0; bits &= bits - 1) {
        const auto [x, y, z] = brick_voxel(unsigned(std::countr_zero(bits)));
        const Colour colour = colours_.of({corner[0] + x, corner[1] + y, corner[2] + z});
        out_->put(0xff000000U | uint32_t(colour.b) << 16 | uint32_t(colour.g) << 8 | colour.r);
      }
      return;
    }
    const uint32_t bit = dag_.levels - 1 - level;
    dag_for_children(dag_, level, node, [&](unsigned c, uint32_t child) {
      put_below(level + 1, child,
                {corner[0] + (c >> 2 << bit), corner[1] + ((c >> 1 & 1) << bit),
                 corner[2] + ((c & 1) << bit)});
    });
  }

 private:
  const DagView& dag_;
  const VoxelColours& colours_;
  Output* out_;
};

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

void write_hashdag(const WholeDag& dag, const std::string& path) {
  const auto base = word_offsets(dag);
  Output out(path);
  put_dag(dag, base, nullptr, &out);
  out.commit();
}

std::string hashdag_colours_path(const std::string& path) {
  return strip_ending(path, ".dag.bin") + ".uncompressed_colors.bin";
}

void write_coloured_hashdag(const WholeDag& dag, const DagFile& coloured, const std::string& path,
                            const WorkRoom& room) {
  constexpr uint64_t kMaxColours = uint64_t(1) << 32;
  const auto base = word_offsets(dag);
  const Enclosed enclosed = count_enclosed(dag, room);
  const uint64_t voxels = enclosed.top[0];
  if (voxels == 0) fail_usage("--colours: there is no voxel to colour");
  if (voxels > kMaxColours)
    fail_usage("--colours: HashDAG holds at most 2^32 colours, there are " + format_count(voxels) +
               " voxels: export a coarser --level, or leave --colours out");
  const VoxelColours of_voxels(coloured, int(dag.levels()), room.budget);
  const std::string colours_path = hashdag_colours_path(path);
  const uint64_t bytes =
      kHeaderBytes + 4 * base[dag.brick_level() + 1] + 20 + 8 * enclosed.top.size() + 4 * voxels;
  const uint64_t free = free_bytes_of(folder_of(path));
  if (bytes > free)
    throw Error(ExitCode::kOutput,
                "the DAG and its colours take " + format_bytes(bytes) + ", and " +
                    format_bytes(free) + " are free: export a coarser --level",
                path);
  Output out(path), colours(colours_path);
  put_dag(dag, base, &enclosed, &out);
  colours.put(enclosed.top_levels);
  colours.put(uint64_t(enclosed.top.size()));
  colours.put(std::as_bytes(std::span(enclosed.top)));
  colours.put(voxels);
  ColourWriter(dag.view(), of_voxels, &colours).put_below(0, 0, {0, 0, 0});
  colours.commit();
  out.commit();
}

std::unique_ptr<NodeGraph> read_hashdag(const File& file) {
  return std::make_unique<HashDagGraph>(file);
}

}  // namespace svdag
