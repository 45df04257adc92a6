#include "io/dag/check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "io/dag/compact_view.h"
#include "io/dag/grid_fields.h"
#include "io/dag/symvox_header.h"
#include "io/grid.h"
#include "streaming/error.h"
#include "streaming/file/checksum.h"

namespace svdag {
namespace {

bool is_compact(const Header& h) {
  return Layout(h.layout) == Layout::kCompact;
}

void require(bool condition, const File& file, const char* sentence, uint64_t offset) {
  if (!condition) fail_input(file.path(), std::string("damaged file: ") + sentence, offset);
}

void check_identity(const File& file, const Header& h) {
  if (std::memcmp(h.magic, kMagic, sizeof kMagic) != 0)
    fail_input(file.path(),
               "is not a .svdag (its first bytes are not \\x89SVDAG): svdag build makes one of a "
               "scene");
  if (h.version < 1 || h.version > kMaxVersion)
    fail_input(file.path(), "has format version " + std::to_string(h.version) +
                                ", this program reads versions 1 to " +
                                std::to_string(kMaxVersion));
  const auto bytes = std::as_bytes(std::span(&h, 1));
  require(checksum64(bytes.first(offsetof(Header, header_checksum))) == h.header_checksum, file,
          "the header does not match its checksum", offsetof(Header, header_checksum));
}

void check_colour_fields(const File& file, const Header& h) {
  if (has_colours(h))
    return require(h.colour_level <= h.levels && h.colour_error <= kMaxColourError &&
                       h.chunks_bytes % 4 == 0 && h.directory_bytes % sizeof(ColourEntry) == 0 &&
                       (h.layer_kind == 0 || h.has_union == 1),
                   file, "impossible colours", offsetof(Header, chunks_offset));
  const uint64_t fields[] = {h.chunks_offset, h.chunks_bytes, h.directory_offset, h.directory_bytes,
                             h.colour_count,  h.colour_error, h.colour_hash[0],   h.colour_hash[1]};
  for (const uint64_t field : fields)
    require(field == 0, file, "colours without a level", offsetof(Header, chunks_offset));
}

void check_fields(const File& file, const Header& h) {
  require(h.header_bytes == sizeof(Header), file, "wrong header size",
          offsetof(Header, header_bytes));
  check_grid(h, [&](bool condition, const char* sentence, uint64_t offset) {
    require(condition, file, sentence, offset);
  });
  require(h.section_count == h.levels - 1, file, "wrong number of sections",
          offsetof(Header, section_count));
  const bool has_origin = h.grid_kind == uint32_t(Grid::Kind::kOrigin);
  for (int a = 0; a < 3; ++a) {
    require(std::isfinite(h.corner[a]), file, "impossible grid corner", offsetof(Header, corner));
    require(std::isfinite(h.origin[a]) && (has_origin || h.origin[a] == 0), file,
            "impossible grid origin", offsetof(Header, origin));
  }
  require(h.layout <= 1 && h.padding == 0 && h.layer_kind < std::size(kLayerKindNames) &&
              h.version == version_of(Layout(h.layout), LayerKind(h.layer_kind), has_colours(h)),
          file, "impossible layout", offsetof(Header, layout));
  const bool layered = h.layer_kind != 0;
  require(h.layer_count <= (layered ? kMaxLayers : 0) && h.has_union <= (layered ? 1 : 0) &&
              h.padding2 == 0 && (layered || (h.layers_offset == 0 && h.layers_bytes == 0)),
          file, "impossible layers", offsetof(Header, layers_offset));
  require(has_table_hash(h) || (h.table_hash[0] == 0 && h.table_hash[1] == 0), file,
          "unknown header field", offsetof(Header, table_hash));
  check_colour_fields(file, h);
  for (const unsigned char byte : h.reserved)
    require(byte == 0, file, "unknown header field", offsetof(Header, reserved));
}

// The sections must follow one another exactly as the format defines, so every byte is checked.
void check_layout(const File& file, const Header& h) {
  uint64_t end = sizeof(Header);
  const uint64_t size = file.size();
  require(h.file_bytes == size, file, "its size differs from the size in its header",
          offsetof(Header, file_bytes));
  const auto expect_section = [&](uint64_t offset, uint64_t bytes, uint64_t field) {
    require(offset == padded(end) && offset <= size && bytes <= size - offset, file,
            "a section is at the wrong offset", field);
    end = offset + bytes;
  };
  const bool compact = is_compact(h);
  for (uint32_t i = 0; i < kMaxSections; ++i) {
    const uint32_t k = compact ? i : kMaxSections - 1 - i;
    const Section& s = h.sections[k];
    const uint64_t field = offsetof(Header, sections) + k * sizeof(Section);
    if (k >= h.section_count) {
      require(s.offset == 0 && s.bytes == 0 && s.nodes == 0, file, "unused section", field);
      continue;
    }
    expect_section(s.offset, s.bytes, field);
    const bool bricks = k + 1 == h.section_count;
    const uint64_t unit = bricks ? 8 : 4;
    require((compact && !bricks) || (s.bytes % unit == 0 && s.bytes / unit <= kMaxWords), file,
            "impossible section size", field);
  }
  if (h.layer_kind != 0)
    expect_section(h.layers_offset, h.layers_bytes, offsetof(Header, layers_offset));
  if (has_colours(h)) {
    expect_section(h.chunks_offset, h.chunks_bytes, offsetof(Header, chunks_offset));
    expect_section(h.directory_offset, h.directory_bytes, offsetof(Header, directory_offset));
  }
  expect_section(h.metadata_offset, h.metadata_bytes, offsetof(Header, metadata_offset));
  expect_section(h.checksum_offset, h.checksum_bytes, offsetof(Header, checksum_offset));
  const uint64_t payload = h.checksum_offset - sizeof(Header);
  const uint64_t blocks = (payload + kChecksumBlock - 1) / kChecksumBlock;
  require(h.checksum_bytes == 8 * blocks && end == size, file, "wrong checksum table",
          offsetof(Header, checksum_bytes));
}

std::vector<uint64_t> read_table(const File& file, const Header& h) {
  std::vector<uint64_t> table(h.checksum_bytes / 8);
  const auto bytes = std::as_writable_bytes(std::span(table));
  file.read_at(h.checksum_offset, bytes);
  Header blank = h;
  blank.content_hash[0] = blank.content_hash[1] = blank.header_checksum = 0;
  Hasher128 hasher;
  if (!has_table_hash(h)) hasher.update(std::as_bytes(std::span(&blank, 1)));
  hasher.update(bytes);
  const uint64_t* const expected = has_table_hash(h) ? h.table_hash : h.content_hash;
  require(hasher.digest() == Hash128{expected[0], expected[1]}, file,
          "the checksum table does not match its hash in the header", h.checksum_offset);
  return table;
}

// Checks the structure of the sections while the file is read in blocks. Offsets and block sizes
// are multiples of 8, so no word is in two blocks.
class StructureScan {
 public:
  StructureScan(const File& file, const Header& h) : file_(file), h_(h), level_(h.section_count) {
    next_level();
  }

  // Checks the payload bytes at file offset `offset`; calls must be contiguous.
  void feed(uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const size_t n = size_t(std::min<uint64_t>(bytes.size(), region_end() - offset));
      if (in_section(offset)) {
        scan(offset, bytes.first(n));
      } else if (std::none_of(parts_.begin(), parts_.end(), [&](const Part& part) {
                   return offset >= part.offset && offset - part.offset < part.bytes;
                 })) {
        for (size_t i = 0; i < n; ++i)
          require(bytes[i] == std::byte(0), file_, "padding is not zero", offset + i);
      }
      offset += n;
      bytes = bytes.subspan(n);
      advance(offset);
    }
  }

  void finish() const {
    require(has_possible_roots(h_), file_, "wrong number of roots", h_.sections[0].offset);
  }

 private:
  const Section& section() const { return h_.sections[level_]; }
  bool in_section(uint64_t offset) const {
    return !done_ && offset >= section().offset && offset < section().offset + section().bytes;
  }
  // The end of the region (padding, section or rest) that contains the position.
  uint64_t region_end() const {
    if (done_) {
      uint64_t end = h_.checksum_offset;
      for (const Part& part : parts_) {
        for (const uint64_t border : {part.offset, part.offset + part.bytes})
          if (border > position_) end = std::min(end, border);
      }
      return end;
    }
    return position_ < section().offset ? section().offset : section().offset + section().bytes;
  }
  void advance(uint64_t offset) {
    position_ = offset;
    while (!done_ && position_ >= section().offset + section().bytes) {
      close_level();
      next_level();
    }
  }
  void next_level() {
    if (level_ == 0) {
      done_ = true;
      return;
    }
    --level_;
    below_ = std::move(starts_);
    starts_.assign(level_ + 2 == h_.levels ? 0 : (section().bytes / 4 + 63) / 64, 0);
    nodes_ = 0;
    word_ = 0;
    pending_ = 0;
    advance(position_);
  }
  void close_level() const {
    const bool bricks = level_ + 2 == h_.levels;
    require(pending_ == 0 && (bricks ? section().bytes / 8 : nodes_) == section().nodes, file_,
            "a level and the header differ in the number of nodes", section().offset);
  }

  void scan(uint64_t offset, std::span<const std::byte> bytes) {
    if (level_ + 2 == h_.levels) return scan_bricks(offset, bytes);
    for (size_t i = 0; i < bytes.size(); i += 4, ++word_) {
      uint32_t word;
      std::memcpy(&word, bytes.data() + i, 4);
      if (pending_ == 0) {
        require(word != 0 && word < 256, file_, "impossible child mask", offset + i);
        starts_[word_ / 64] |= uint64_t(1) << (word_ % 64);
        pending_ = std::popcount(word);
        ++nodes_;
      } else {
        require(starts_below(word), file_, "a child pointer does not lead to a node", offset + i);
        --pending_;
      }
    }
  }
  // Any u64 is a safe brick, but 0 contradicts the child masks above it.
  void scan_bricks(uint64_t offset, std::span<const std::byte> bytes) const {
    for (size_t i = 0; i < bytes.size(); i += 8) {
      uint64_t brick;
      std::memcpy(&brick, bytes.data() + i, 8);
      require(brick != 0, file_, "an empty brick", offset + i);
    }
  }
  bool starts_below(uint32_t word) const {
    const Section& below = h_.sections[level_ + 1];
    if (level_ + 3 == h_.levels) return word < below.nodes;
    return word < below.bytes / 4 && (below_[word / 64] >> (word % 64) & 1U) != 0;
  }

  // What follows the sections, apart from padding; all zeros if the file does not have it.
  struct Part {
    uint64_t offset, bytes;
  };

  const File& file_;
  const Header& h_;
  const std::array<Part, 4> parts_{{{h_.layers_offset, h_.layers_bytes},
                                    {h_.chunks_offset, h_.chunks_bytes},
                                    {h_.directory_offset, h_.directory_bytes},
                                    {h_.metadata_offset, h_.metadata_bytes}}};
  uint32_t level_;
  bool done_ = false;
  uint64_t position_ = sizeof(Header);
  std::vector<uint64_t> starts_, below_;  // bitmaps of the words that begin a node
  uint64_t nodes_ = 0;
  uint64_t word_ = 0;
  int pending_ = 0;  // pointers of the current node that are not read yet
};

}  // namespace

void check_header(const File& file, const Header& header) {
  check_identity(file, header);
  check_fields(file, header);
}

Header check_dag(const File& file) {
  Header h{};
  const size_t bytes_read = file.read_some_at(0, std::as_writable_bytes(std::span(&h, 1)));
  const bool has_magic = std::memcmp(h.magic, kMagic, sizeof kMagic) == 0;
  if (!has_magic) reject_symvox(file);
  if (has_magic && bytes_read < sizeof h)
    fail_input(file.path(), "damaged file: it ends within its header", bytes_read);
  check_header(file, h);
  check_layout(file, h);
  const std::vector<uint64_t> table = read_table(file, h);
  std::optional<StructureScan> scan;
  if (!is_compact(h)) scan.emplace(file, h);
  std::vector<std::byte> block(
      size_t(std::min<uint64_t>(kChecksumBlock, h.checksum_offset - sizeof(Header))));
  for (size_t i = 0; i < table.size(); ++i) {
    const uint64_t offset = sizeof(Header) + i * kChecksumBlock;
    const auto bytes = std::span(block).first(
        size_t(std::min<uint64_t>(kChecksumBlock, h.checksum_offset - offset)));
    file.read_at(offset, bytes);
    require(checksum64(bytes) == table[i], file, "a block does not match its checksum", offset);
    if (scan) scan->feed(offset, bytes);
  }
  if (scan) scan->finish();
  return h;
}

}  // namespace svdag
