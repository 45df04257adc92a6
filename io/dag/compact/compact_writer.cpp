#include "io/dag/compact/compact_writer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "io/dag/compact/compact_classes.h"
#include "io/dag/metadata.h"
#include "io/dag/write/node_starts.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Appends to one part of a file.
class PartWriter {
 public:
  PartWriter(AtomicFile* file, uint64_t offset) : file_(file), offset_(offset) {
    buffer_.reserve(kBuffer);
  }

  template <class T>
  void put(const T* values, size_t count) {
    const auto* bytes = reinterpret_cast<const std::byte*>(values);
    buffer_.insert(buffer_.end(), bytes, bytes + count * sizeof(T));
    if (buffer_.size() >= kBuffer) flush();
  }
  void flush() {
    file_->write_at(offset_, buffer_);
    offset_ += buffer_.size();
    buffer_.clear();
  }
  // Fills up to offset `end` with zeros.
  void finish(uint64_t end) {
    SVDAG_ASSERT(end - offset_ >= buffer_.size());
    buffer_.resize(end - offset_);
    flush();
  }

 private:
  static constexpr size_t kBuffer = size_t(1) << 16;
  AtomicFile* file_;
  uint64_t offset_;
  std::vector<std::byte> buffer_;
};

// A stream of references.
class BitWriter {
 public:
  BitWriter(AtomicFile* file, uint64_t offset, uint32_t width)
      : part_(file, offset), width_(width) {}

  void put(uint64_t value) {
    bits_ |= value << used_;
    used_ += width_;
    if (used_ < 64) return;
    part_.put(&bits_, 1);
    used_ -= 64;
    bits_ = used_ == 0 ? 0 : value >> (width_ - used_);
  }
  void finish(uint64_t end) {
    part_.put(reinterpret_cast<const std::byte*>(&bits_), (used_ + 7) / 8);
    part_.finish(end);
  }

 private:
  PartWriter part_;
  uint32_t width_;
  uint64_t bits_ = 0;
  uint32_t used_ = 0;  // bits of bits_
};

// The nodes of the level below, as seen from a level: ranks in content order.
class LevelBelow {
 public:
  LevelBelow(const DagView& dag, uint32_t level, const WorkRoom& room)
      : dag_(dag), level_(level + 1), starts_(room.budget, "numbers of nodes") {
    if (!bricks()) starts_ = node_starts(dag, level_, room.budget);
  }
  uint64_t nodes() const { return bricks() ? dag_.brick_count : starts_.count(); }
  uint32_t rank(uint32_t index) const { return bricks() ? index : starts_.rank(index); }
  // Calls visit(index) in content order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    if (!bricks()) return starts_.for_each(visit);
    for (uint64_t i = 0; i < dag_.brick_count; ++i) visit(uint32_t(i));
  }

 private:
  bool bricks() const { return level_ == dag_.brick_level(); }
  const DagView& dag_;
  uint32_t level_;
  RankBitmap starts_;
};

NodeClasses classes_of(const DagView& dag, uint32_t level, uint64_t nodes, const LevelBelow& below,
                       WorkArray<uint32_t>* references) {
  // A reference is counted kDelay references after its counter was prefetched.
  constexpr uint64_t kDelay = 32;
  std::array<uint32_t, kDelay> ranks{};
  uint64_t found = 0;
  for (uint64_t i = 0; i < dag.index_end[level]; i = dag_next(dag, level, i)) {
    dag_for_children(dag, level, uint32_t(i), [&](unsigned, uint32_t child) {
      uint32_t& slot = ranks[found % kDelay];
      if (found++ >= kDelay) ++(*references)[slot];
      slot = below.rank(child);
      __builtin_prefetch(&(*references)[slot]);
    });
  }
  for (uint64_t i = 0; i < std::min(found, kDelay); ++i) ++(*references)[ranks[i]];
  ReferenceCounts counts;
  for (const uint32_t count : references->elements()) counts.add(count);
  check_interrupt();
  return {counts, nodes};
}

class CompactWriter {
 public:
  CompactWriter(const DagFile& plain, const std::string& path, const WorkRoom& room)
      : plain_(plain), dag_(plain.view()), room_(room), file_(path), header_(plain.header()) {
    SVDAG_ASSERT(dag_.layout == Layout::kPlain);
    clear_colours(&header_);
    header_.version = version_of(Layout::kCompact, LayerKind(header_.layer_kind));
    header_.layout = uint32_t(Layout::kCompact);
  }

  // Writes all of the file, which has no name yet.
  void run() {
    order_ = WorkArray<uint32_t>(header_.sections[0].nodes, room_);
    uint32_t number = 0;
    for (uint64_t i = 0; i < dag_.index_end[0]; i = dag_next(dag_, 0, i))
      order_[number++] = uint32_t(i);
    for (uint32_t level = 0; level < dag_.brick_level(); ++level) {
      begin_section(level);
      if (!dag_.empty()) write_level(level);
    }
    write_bricks();
    finish();
  }
  const Header& header() const { return header_; }
  AtomicFile* file() { return &file_; }

 private:
  static constexpr uint32_t kUnplaced = 0xffffffffU;
  static constexpr uint64_t kAhead = 16;  // nodes

  void begin_section(uint32_t level) {
    end_ = padded(end_);
    header_.sections[level].offset = end_;
    header_.sections[level].bytes = 0;
  }

  void write_level(uint32_t level) {
    Section& section = header_.sections[level];
    const LevelBelow below(dag_, level, room_);
    WorkArray<uint32_t> numbers(below.nodes(), room_);  // [rank]: first of references, then its own
    NodeClasses classes = classes_of(dag_, level, section.nodes, below, &numbers);
    const CompactEntry& entry = classes.entry();
    section.bytes = compact_bytes(entry, section.nodes);
    end_ = section.offset + section.bytes;
    file_.write_at(section.offset, std::as_bytes(std::span(&entry, 1)));

    // Numbers the nodes below, except the private ones.
    WorkArray<uint32_t> order(below.nodes(), room_);
    uint32_t next[kClasses] = {0, entry.sizes[0], entry.sizes[0] + entry.sizes[1]};
    uint64_t rank = 0;
    below.for_each([&](uint32_t index) {
      const uint32_t s = classes.class_of(numbers[rank]);
      const bool is_private = s == 0 && classes.has_private();
      numbers[rank] = is_private ? kUnplaced : next[s]++;
      if (!is_private) order[numbers[rank]] = index;
      ++rank;
    });
    emit(level, entry, below, &numbers, &order);
    order_ = std::move(order);
  }

  void emit(uint32_t level, const CompactEntry& entry, const LevelBelow& below,
            WorkArray<uint32_t>* numbers, WorkArray<uint32_t>* order) {
    const Section& section = header_.sections[level];
    const uint64_t lines_at = section.offset + sizeof(CompactEntry);
    const uint64_t bases_at = lines_at + compact_lines(section.nodes) * 2 * kLineNodes;
    PartWriter lines(&file_, lines_at), bases(&file_, bases_at);
    std::vector<BitWriter> streams;
    uint64_t stream_end[kClasses], at = bases_at + base_table_bytes(section.nodes);
    for (uint32_t s = 0; s < kClasses; ++s) {
      streams.emplace_back(&file_, at, entry.widths[s]);
      stream_end[s] = at += stream_bytes(entry, s);
    }
    const uint32_t first[kClasses] = {0, entry.sizes[0], entry.sizes[0] + entry.sizes[1]};
    uint32_t placed = 0, used[kClasses] = {};
    // Of the children of the next nodes; their words are prefetched before, their numbers here.
    std::array<std::array<uint32_t, 8>, kAhead> ring;
    const auto look_up = [&](uint64_t node) {
      uint32_t* rank = ring[node % kAhead].data();
      dag_for_children(dag_, level, order_[node], [&](unsigned, uint32_t child) {
        *rank = below.rank(child);
        __builtin_prefetch(&(*numbers)[*rank++]);
      });
    };
    for (uint64_t node = 0; node < std::min(kAhead - 1, section.nodes); ++node) look_up(node);
    unsigned char line[2][kLineNodes];
    for (uint64_t node = 0; node < section.nodes; ++node) {
      const uint32_t i = node % kLineNodes;
      if (i == 0) {
        std::memset(line, 0, sizeof line);
        bases.put(used, kClasses);
        check_interrupt();
      }
      if (node + 2 * kAhead < section.nodes)
        __builtin_prefetch(dag_.words[level] + order_[node + 2 * kAhead]);
      if (node + kAhead - 1 < section.nodes) look_up(node + kAhead - 1);
      const uint32_t* rank = ring[node % kAhead].data();
      dag_for_children(dag_, level, order_[node], [&](unsigned c, uint32_t child) {
        const uint32_t number = (*numbers)[*rank++];
        uint32_t s = 0;
        if (number == kUnplaced) {  // its only reference
          (*order)[placed++] = child;
        } else {
          s = uint32_t(number >= first[1]) + uint32_t(number >= first[2]);
          streams[s].put(number - first[s]);
        }
        ++used[s];
        line[0][i] |= static_cast<unsigned char>(((s + 1) & 1) << c);
        line[1][i] |= static_cast<unsigned char>(((s + 1) >> 1) << c);
      });
      if (i + 1 == kLineNodes || node + 1 == section.nodes) lines.put(line[0], sizeof line);
    }
    lines.finish(bases_at);
    bases.finish(stream_end[0] - stream_bytes(entry, 0));
    for (uint32_t s = 0; s < kClasses; ++s) {
      if (has_stream(entry, s)) streams[s].finish(stream_end[s]);
    }
  }

  void write_bricks() {
    const uint32_t level = dag_.brick_level();
    begin_section(level);
    Section& section = header_.sections[level];
    PartWriter bricks(&file_, section.offset);
    for (uint64_t i = 0; i < dag_.brick_count; ++i) {
      if (i + kAhead < dag_.brick_count) __builtin_prefetch(dag_.bricks + order_[i + kAhead]);
      bricks.put(&dag_.bricks[order_[i]], 1);
    }
    section.bytes = dag_.brick_count * sizeof(uint64_t);
    end_ = section.offset + section.bytes;
    bricks.finish(end_);
    order_ = {};
  }

  // Writes everything after the sections, and the header.
  void finish() {
    if (header_.layer_kind != 0) {
      const auto layers = plain_.bytes().subspan(header_.layers_offset, header_.layers_bytes);
      header_.layers_offset = padded(end_);
      file_.write_at(header_.layers_offset, layers);
      end_ = header_.layers_offset + header_.layers_bytes;
    }
    const std::string json = metadata_of(header_);
    header_.metadata_offset = padded(end_);
    header_.metadata_bytes = json.size();
    header_.checksum_offset = padded(header_.metadata_offset + json.size());
    file_.write_at(header_.metadata_offset, std::as_bytes(std::span(json)));
    const std::vector<uint64_t> checksums = block_checksums();
    const auto table = std::as_bytes(std::span(checksums));
    header_.checksum_bytes = table.size();
    header_.file_bytes = header_.checksum_offset + table.size();
    file_.write_at(header_.checksum_offset, table);
    Hasher128 hasher;
    hasher.update(table);
    const Hash128 hash = hasher.digest();
    std::memcpy(header_.table_hash, hash.data(), sizeof hash);
    const auto bytes = std::as_bytes(std::span(&header_, 1));
    header_.header_checksum = checksum64(bytes.first(offsetof(Header, header_checksum)));
    file_.write_at(0, bytes);
  }

  // Parts are written side by side, so the checksums are computed from the file.
  std::vector<uint64_t> block_checksums() {
    const std::byte zero{};
    if (file_.size() < header_.checksum_offset)
      file_.write_at(header_.checksum_offset - 1, std::span(&zero, 1));
    std::vector<uint64_t> checksums;
    std::vector<std::byte> block(kChecksumBlock);
    for (uint64_t at = sizeof(Header); at < header_.checksum_offset; at += kChecksumBlock) {
      const auto bytes = std::span(block).first(
          size_t(std::min<uint64_t>(kChecksumBlock, header_.checksum_offset - at)));
      file_.read_at(at, bytes);
      checksums.push_back(checksum64(bytes));
    }
    return checksums;
  }

  const DagFile& plain_;
  const DagView& dag_;
  const WorkRoom& room_;
  AtomicFile file_;
  Header header_;
  uint64_t end_ = sizeof(Header);  // of the sections so far
  WorkArray<uint32_t> order_;      // [number]: index of each node of the level, in the plain layout
};

}  // namespace

Header write_compact(const DagFile& plain, const std::string& path, const WorkRoom& room) {
  CompactWriter writer(plain, path, room);
  writer.run();
  writer.file()->commit();
  return writer.header();
}

DagFile compact_form(const DagFile& plain, const std::string& shown_as, const WorkRoom& room) {
  CompactWriter writer(plain, room.folder + "/compact.svdag", room);
  writer.run();
  return DagFile::map_valid(File::open_read(writer.file()->open_name()), shown_as);
}

bool is_compact_form(const DagFile& compact, const DagFile& plain, const WorkRoom& room) {
  CompactWriter writer(plain, room.folder + "/compact.svdag", room);
  writer.run();
  const std::span<const std::byte> expected = compact.bytes();
  if (writer.header().file_bytes != expected.size()) return false;
  std::vector<std::byte> block(kChecksumBlock);
  for (uint64_t at = 0; at < expected.size(); at += kChecksumBlock) {
    const auto part =
        expected.subspan(at, std::min<uint64_t>(kChecksumBlock, expected.size() - at));
    const auto bytes = std::span(block).first(part.size());
    writer.file()->read_at(at, bytes);
    if (!std::equal(bytes.begin(), bytes.end(), part.begin())) return false;
  }
  return true;
}

std::vector<uint64_t> compact_section_bytes(const DagView& dag, const WorkRoom& room) {
  SVDAG_ASSERT(dag.layout == Layout::kPlain);
  std::vector<uint64_t> bytes(dag.brick_level() + 1);
  if (dag.empty()) return bytes;
  uint64_t nodes = 0;
  for (uint64_t i = 0; i < dag.index_end[0]; i = dag_next(dag, 0, i)) ++nodes;
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    const LevelBelow below(dag, level, room);
    WorkArray<uint32_t> references(below.nodes(), room);
    bytes[level] = compact_bytes(classes_of(dag, level, nodes, below, &references).entry(), nodes);
    nodes = below.nodes();
  }
  bytes.back() = dag.brick_count * sizeof(uint64_t);
  return bytes;
}

std::vector<uint64_t> plain_section_bytes(const DagView& dag) {
  SVDAG_ASSERT(dag.layout == Layout::kCompact);
  std::vector<uint64_t> bytes(dag.brick_level() + 1);
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    uint64_t words = 0;
    for (uint64_t i = 0; i < dag.index_end[level]; ++i)
      words += 1 + uint64_t(popcount8(dag_mask(dag, level, uint32_t(i))));
    bytes[level] = words * sizeof(uint32_t);
  }
  bytes.back() = dag.brick_count * sizeof(uint64_t);
  return bytes;
}

}  // namespace svdag
