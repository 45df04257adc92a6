#include "builder/run/run_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/dag/grid_fields.h"
#include "streaming/error.h"

namespace svdag {
namespace {

void check_identity(const File& file, const RunHeader& h) {
  if (std::memcmp(h.magic, kRunMagic, sizeof kRunMagic) != 0)
    fail_input(file.path(), "is not a run (its first bytes are not \\x89SVRUN)");
  if (h.version != kRunVersion)
    fail_input(file.path(), "has run format version " + std::to_string(h.version) +
                                ", this program reads version " + std::to_string(kRunVersion));
  require_run(checksum_of(h) == h.header_checksum, file, "the header does not match its checksum",
              offsetof(RunHeader, header_checksum));
}

void check_grid_fields(const File& file, const RunHeader& h) {
  check_grid(h, [&](bool condition, const char* sentence, uint64_t offset) {
    require_run(condition, file, sentence, offset);
  });
  for (int a = 0; a < 3; ++a) {
    require_run(std::isfinite(h.origin[a]) && (h.grid_kind != 1 || h.origin[a] == 0), file,
                "impossible grid corner", offsetof(RunHeader, origin));
    require_run(h.grid_kind != 0 || h.k0[a] == 0, file, "impossible grid corner",
                offsetof(RunHeader, k0));
  }
}

// Checks the counts against the file size before anything is allocated by them.
void check_counts(const File& file, const RunHeader& h) {
  const uint64_t size = file.size();
  require_run(h.header_bytes == sizeof(RunHeader), file, "wrong header size",
              offsetof(RunHeader, header_bytes));
  require_run(h.block_bytes == kRunBlockBytes, file, "wrong block size",
              offsetof(RunHeader, block_bytes));
  require_run(h.file_bytes == size, file, "its size differs from the size in its header",
              offsetof(RunHeader, file_bytes));
  require_run(h.voxels <= uint64_t(1) << 3 * h.levels, file, "impossible number of voxels",
              offsetof(RunHeader, voxels));
  require_run(std::isfinite(h.largest_snap) && h.largest_snap >= 0, file, "impossible snap move",
              offsetof(RunHeader, largest_snap));
  for (uint32_t k = 0; k < kRunLevels; ++k) {
    const uint64_t count = h.keys[k];
    require_run(count <= kMaxRunKeys && count <= size / 8, file, "impossible number of nodes",
                offsetof(RunHeader, keys) + 8 * k);
    require_run(count == 0 || k + 1 < h.levels, file, "unused level",
                offsetof(RunHeader, keys) + 8 * k);
  }
  require_run(h.ranges <= size / sizeof(StoredRange), file, "impossible number of ranges",
              offsetof(RunHeader, ranges));
  require_run(h.roots <= size / sizeof(StoredRoot), file, "impossible number of roots",
              offsetof(RunHeader, roots));
  const bool layered = h.layer_kind != 0;
  require_run(h.layers_bytes <= (layered ? size : 0) &&
                  h.layer_count <= (layered ? kMaxLayers : 0) &&
                  h.layer_kind < std::size(kLayerKindNames) && h.has_union <= (layered ? 1 : 0) &&
                  h.padding == 0,
              file, "impossible layers", offsetof(RunHeader, layers_bytes));
  require_run(RunLayout(h).file_bytes == size, file, "the file size does not match the counts",
              offsetof(RunHeader, file_bytes));
  for (const unsigned char byte : h.reserved)
    require_run(byte == 0, file, "unknown header field", offsetof(RunHeader, reserved));
}

RunHeader read_header(const File& file) {
  RunHeader header{};
  const auto bytes = std::as_writable_bytes(std::span(&header, 1));
  const size_t n = file.read_some_at(0, bytes);
  if (n < bytes.size() && n >= sizeof kRunMagic &&
      std::memcmp(header.magic, kRunMagic, sizeof kRunMagic) == 0)
    throw Error(ExitCode::kBadInput, "ends too early", file.path(), n);
  check_identity(file, header);
  check_grid_fields(file, header);
  check_counts(file, header);
  return header;
}

template <class Item>
std::vector<Item> read_items(const File& file, const RunHeader& header, const RunSection& section,
                             MemoryBudget* budget) {
  std::vector<Item> items(section.bytes() / sizeof(Item));
  RunReader reader(file, header, section, budget);
  std::byte* to = reinterpret_cast<std::byte*>(items.data());
  for (auto block = reader.next(); !block.empty(); block = reader.next()) {
    std::memcpy(to, block.data(), block.size());
    to += block.size();
  }
  return items;
}

}  // namespace

void require_run(bool condition, const File& file, const char* sentence, uint64_t offset) {
  if (!condition) fail_input(file.path(), std::string("damaged run: ") + sentence, offset);
}

RunFile RunFile::open(const std::string& path, MemoryBudget* budget, InputWatch* watch) {
  File file = File::open_read(path);
  if (watch != nullptr) watch->add(file);
  const RunHeader header = read_header(file);
  return RunFile(std::move(file), header, budget);
}

RunFile::RunFile(File file, const RunHeader& header, MemoryBudget* budget)
    : file_(std::move(file)),
      header_(header),
      layout_(header),
      counted_(budget->reserve(2 * layout_.ranges.bytes() + layout_.roots.bytes() +
                                   header.roots * sizeof(SubDagRoot) + 2 * layout_.layers.bytes(),
                               "parts and roots of runs")),
      part_({}, int(header.levels)) {
  read_part(budget);
  read_roots(budget);
  read_layers(budget);
}

void RunFile::read_layers(MemoryBudget* budget) {
  if (header_.layer_kind == 0) return;
  const auto bytes = read_items<std::byte>(file_, header_, layout_.layers, budget);
  auto layers = decode_entries(header_.layer_count, bytes);
  const bool valid = layers && std::ranges::all_of(*layers, [](const Layer& layer) {
                       return layer.root == kNoRoot;
                     });
  require_run(valid, file_, "an impossible layer table", offsetof(RunHeader, layers_bytes));
  layers_ = {LayerKind(header_.layer_kind), header_.has_union != 0, 0, std::move(*layers)};
}

void RunFile::read_part(MemoryBudget* budget) {
  const auto stored = read_items<StoredRange>(file_, header_, layout_.ranges, budget);
  const uint64_t all = uint64_t(1) << 3 * header_.levels;
  constexpr uint64_t kBrick = 64;  // voxels
  std::vector<MortonRange> ranges;
  for (const StoredRange& range : stored) {
    require_run(range.begin < range.end && range.end <= all && range.begin % kBrick == 0 &&
                    range.end % kBrick == 0 && (ranges.empty() || ranges.back().end < range.begin),
                file_, "impossible range of the part", offsetof(RunHeader, ranges));
    ranges.push_back({range.begin, range.end});
  }
  require_run(run_number(header_, stored) == header_.run, file_,
              "the run number does not match the part", offsetof(RunHeader, run));
  part_ = GridPart(std::move(ranges), int(header_.levels));
}

void RunFile::read_roots(MemoryBudget* budget) {
  // By position (a Morton code of voxels), then by set.
  std::pair<uint64_t, uint32_t> next{0, header_.has_union != 0 || header_.layer_kind == 0 ? 0 : 1};
  const uint32_t first_set = next.second;
  for (const StoredRoot& root : read_items<StoredRoot>(file_, header_, layout_.roots, budget)) {
    const uint32_t level = root.level_and_set & 0xff, set = root.level_and_set >> 8;
    require_run(level <= header_.levels - 2 && root.code >> 3 * level == 0 &&
                    root.rank < header_.keys[level] && set >= first_set &&
                    set <= header_.layer_count,
                file_, "impossible root", offsetof(RunHeader, roots));
    const int shift = 3 * int(header_.levels - level);
    const uint64_t position = root.code << shift;
    require_run(std::pair(position, set) >= next && part_.is_top(int(level), root.code), file_,
                "a root is not a top of the part or not in order", offsetof(RunHeader, roots));
    next = {position, set + 1};
    roots_.push_back({root.code, int32_t(level), 0, root.rank, SubDagSets::only(set)});
  }
}

Grid RunFile::grid() const {
  return get_grid(header_, header_.origin);
}

std::unique_ptr<BlockSource> RunFile::read(int level, MemoryBudget* budget) const {
  return std::make_unique<RunReader>(file_, header_, layout_.levels[level], budget);
}

RunReader::RunReader(const File& file, const RunHeader& header, const RunSection& section,
                     MemoryBudget* budget)
    : file_(file), run_(header.run), payload_(RunLayout(header).payload), left_(section) {
  if (left_.bytes() == 0) return;
  const uint64_t largest =
      std::min(kRunPayload, payload_ - left_.begin / kRunPayload * kRunPayload);
  block_ = SpillBlock(budget, kSpillHeader + largest);
}

std::span<std::byte> RunReader::next() {
  if (left_.bytes() == 0) return {};
  const uint64_t index = left_.begin / kRunPayload, first = index * kRunPayload;
  const uint64_t length = std::min(kRunPayload, payload_ - first);
  const uint64_t offset = sizeof(RunHeader) + index * kRunBlockBytes;
  const std::span<std::byte> block = block_.bytes().first(kSpillHeader + length);
  file_.read_at(offset, block);
  checksum_ = block_checksum(block);
  require_run(open_block(block, {run_, index, uint32_t(length)}), file_,
              "a block does not match its checksum", offset);
  const uint64_t end = std::min(left_.end, first + length);
  const auto part = block.subspan(kSpillHeader + (left_.begin - first), end - left_.begin);
  left_.begin = end;
  return part;
}

}  // namespace svdag
