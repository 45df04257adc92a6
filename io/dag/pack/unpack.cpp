#include "io/dag/pack/unpack.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include "io/dag/check.h"
#include "io/dag/colours/colours_check.h"
#include "io/dag/colours/dag_copy.h"
#include "io/dag/pack/node_streams.h"
#include "io/dag/pack/pack_format.h"
#include "io/dag/pack/zstd.h"
#include "io/dag/write/dag_writer.h"
#include "streaming/file/checksum.h"
#include "streaming/file/input_watch.h"
#include "streaming/process/interrupt.h"
#include "streaming/sort/turns.h"

namespace svdag {
namespace {

// Writes the streams of a chunk to `streams`; false if it does not hold exactly these streams, or
// if one exceeds its limit.
bool read_streams(std::span<const std::byte> chunk, size_t nodes, ZstdDecoder* zstd,
                  std::span<Stream> streams) {
  const size_t count = streams.size();
  size_t at = 2 * count * sizeof(uint32_t);
  if (chunk.size() < at) return false;
  for (size_t i = 0; i < count; ++i) {
    uint32_t sizes[2];
    std::memcpy(sizes, chunk.data() + i * sizeof sizes, sizeof sizes);
    const size_t most = count == kBrickStreams ? nodes : max_stream_bytes(i, nodes);
    if (sizes[0] > most || sizes[1] > chunk.size() - at) return false;
    streams[i].resize(sizes[0]);
    if (!zstd->decode(chunk.subspan(at, sizes[1]), streams[i])) return false;
    at += sizes[1];
  }
  return at == chunk.size();
}

// A chunk while it is unpacked; the memory serves for the next ones.
struct UnpackedChunk {
  ZstdDecoder zstd;
  std::vector<std::byte> bytes;
  std::array<Stream, kNodeStreams> streams;
  std::vector<Brick> bricks;
  ChunkNodes nodes;
  LevelPiece piece;
};

class Unpacker {
 public:
  Unpacker(const std::string& path, const WorkRoom& room, Executor* executor)
      : room_(room), executor_(executor), file_(File::open_read(path)) {
    inputs_.add(file_);
    read_header();
    read_layers();
    read_index();
  }

  const Header& plain() const { return header_.plain; }
  const LayerTable& layers() const { return layers_; }

  // Writes all levels; the writer must be one for the grid and rule of plain().
  void run(DagWriter* writer) {
    const Header& h = header_.plain;
    for (uint32_t level = h.levels - 1; level-- > 0;) {
      writer->begin_level(int(level));
      const std::span<const ChunkEntry> chunks = next_chunks(h.sections[level].nodes);
      WorkArray<uint32_t> placed(h.sections[level].nodes + 1, room_);
      if (level > 0) {
        write_level(level, chunks, writer, &placed);
      } else {
        write_roots(chunks, writer);
      }
      placed_ = std::move(placed);
    }
    if (!has_colours(h)) require_end();
  }
  // Adds the colours to a copy of what run() has written.
  void add_colours(DagCopy* copy) {
    const Header& h = header_.plain;
    ColourParts parts(copy, h.colour_level, h.colour_error, h.colour_count);
    read_part(h.chunks_bytes, [&](std::span<const std::byte> bytes) { parts.add_chunks(bytes); });
    parts.begin_directory();
    read_part(h.directory_bytes,
              [&](std::span<const std::byte> bytes) { parts.add_entries(bytes); });
    parts.finish();
    require_end();
  }
  // Checks the finished file.
  void require_same(const Header& header) const {
    require(std::memcmp(&header, &header_.plain, sizeof header) == 0,
            has_colours(header) ? "the nodes or colours do not match their hashes"
                                : "the nodes do not match the content hash",
            offsetof(PackedHeader, plain));
  }
  // So that a reader may look the colours up.
  void require_colours(const DagFile& file) const {
    if (const auto defect = colours_defect(file.bytes().data()))
      require(false, defect->sentence, offsetof(PackedHeader, plain));
  }

 private:
  void require(bool condition, const char* sentence, uint64_t offset) const {
    if (!condition) fail_input(file_.path(), std::string("damaged file: ") + sentence, offset);
  }

  void read_header() {
    const size_t size = file_.read_some_at(0, std::as_writable_bytes(std::span(&header_, 1)));
    if (size < sizeof kPackedMagic ||
        std::memcmp(header_.magic, kPackedMagic, sizeof kPackedMagic) != 0)
      fail_input(file_.path(), "is not a packed file");
    require(size == sizeof header_, "it ends within its header", size);
    if (header_.version < 1 || header_.version > kMaxPackedVersion)
      fail_input(file_.path(), "has pack version " + std::to_string(header_.version) +
                                   ", this program reads versions 1 to " +
                                   std::to_string(kMaxPackedVersion));
    const auto bytes = std::as_bytes(std::span(&header_, 1));
    require(checksum64(bytes.first(offsetof(PackedHeader, checksum))) == header_.checksum,
            "the header does not match its checksum", offsetof(PackedHeader, checksum));
    check_header(file_, header_.plain);
    require(header_.padding == 0 && header_.plain.layout == uint32_t(Layout::kPlain) &&
                header_.version == packed_version(header_.plain),
            "unknown header field", offsetof(PackedHeader, padding));
  }

  void read_layers() {
    const uint64_t bytes = header_.plain.layers_bytes;
    require(bytes <= file_.size() - sizeof header_, "it ends within its layer table", file_.size());
    std::vector<std::byte> table(bytes);
    file_.read_at(sizeof header_, table);
    auto layers = decode_layers(header_.plain, table);
    require(layers.has_value(), "an impossible layer table", sizeof header_);
    layers_ = std::move(*layers);
  }

  void read_index() {
    const uint64_t size = file_.size();
    require(header_.index_offset <= size && header_.chunks <= size / sizeof(ChunkEntry) &&
                size - header_.index_offset == header_.chunks * sizeof(ChunkEntry),
            "the index is not at the end", offsetof(PackedHeader, index_offset));
    index_.resize(header_.chunks);
    const auto bytes = std::as_writable_bytes(std::span(index_));
    file_.read_at(header_.index_offset, bytes);
    require(checksum64(bytes) == header_.index_checksum, "the index does not match its checksum",
            header_.index_offset);
    uint64_t end = sizeof(PackedHeader) + header_.plain.layers_bytes, nodes = 0;
    for (const Section& section : header_.plain.sections) nodes += section.nodes;
    nodes += bricks_of_bytes(header_.plain.chunks_bytes);
    nodes += bricks_of_bytes(header_.plain.directory_bytes);
    for (size_t i = 0; i < index_.size(); ++i) {
      const uint64_t at = header_.index_offset + i * sizeof(ChunkEntry);
      require(index_[i].offset == end && index_[i].bytes <= header_.index_offset - end &&
                  index_[i].nodes > 0 && index_[i].nodes <= kChunkNodes &&
                  index_[i].bytes <= max_chunk_bytes(index_[i].nodes),
              "an impossible entry of the index", at);
      end += index_[i].bytes;
      nodes -= index_[i].nodes;
    }
    require(nodes == 0, "the index and the header differ in the number of nodes",
            header_.index_offset);
    require(end == header_.index_offset, "bytes between the chunks and the index", end);
  }

  // The next chunks: a level of `nodes` nodes.
  std::span<const ChunkEntry> next_chunks(uint64_t nodes) {
    const size_t first = next_chunk_;
    while (nodes > 0) {
      require(next_chunk_ < index_.size() && index_[next_chunk_].nodes <= nodes,
              "a level and the header differ in the number of nodes", header_.index_offset);
      nodes -= index_[next_chunk_++].nodes;
    }
    return std::span(index_).subspan(first, next_chunk_ - first);
  }

  void require_end() {
    require(next_chunk_ == index_.size(), "wrong number of chunks", header_.index_offset);
    inputs_.check();
  }

  void require_ascending(bool ascend, const ChunkEntry& entry) const {
    require(ascend, "nodes are empty or do not ascend", entry.offset);
  }

  void read_bytes(const ChunkEntry& entry, UnpackedChunk* chunk) const {
    chunk->bytes.resize(entry.bytes);
    file_.read_at(entry.offset, chunk->bytes);
    require(checksum64(chunk->bytes) == entry.checksum, "a chunk does not match its checksum",
            entry.offset);
  }

  void read_bricks(const ChunkEntry& entry, UnpackedChunk* chunk) const {
    read_bytes(entry, chunk);
    const auto streams = std::span(chunk->streams).first<kBrickStreams>();
    require(read_streams(chunk->bytes, entry.nodes, &chunk->zstd, streams) &&
                bricks_of_streams(streams, entry.nodes, &chunk->bricks),
            "a chunk does not hold nodes", entry.offset);
  }

  // Calls add(bytes) for the chunks of a part of the colours.
  template <class Add>
  void read_part(uint64_t bytes, const Add& add) {
    UnpackedChunk chunk;
    for (const ChunkEntry& entry : next_chunks(bricks_of_bytes(bytes))) {
      check_interrupt();
      read_bricks(entry, &chunk);
      const auto part = std::as_bytes(std::span(chunk.bricks));
      const size_t used = size_t(std::min<uint64_t>(bytes, part.size()));
      require(std::ranges::all_of(part.subspan(used), [](std::byte b) { return b == std::byte(); }),
              "padding of the colours is not zero", entry.offset);
      add(part.first(used));
      bytes -= used;
    }
  }

  void read_nodes(uint32_t level, const ChunkEntry& entry, UnpackedChunk* chunk) const {
    read_bytes(entry, chunk);
    require(read_streams(chunk->bytes, entry.nodes, &chunk->zstd, chunk->streams) &&
                nodes_of_streams(chunk->streams, entry.nodes,
                                 header_.plain.sections[level + 1].nodes, &chunk->nodes),
            "a chunk does not hold nodes", entry.offset);
    place(chunk->nodes.children);
  }

  // Reads a chunk of a level below the roots into chunk->piece.
  void encode(uint32_t level, const ChunkEntry& entry, const DagWriter& writer,
              UnpackedChunk* chunk) const {
    chunk->piece.clear();
    if (level + 2 == header_.plain.levels) {
      read_bricks(entry, chunk);
      require_ascending(std::ranges::is_sorted(chunk->bricks, std::less_equal()), entry);
      writer.encode(std::span<const Brick>(chunk->bricks), &chunk->piece);
    } else {
      read_nodes(level, entry, chunk);
      require_ascending(chunk->nodes.ascend, entry);
      writer.encode(chunk->nodes.masks, chunk->nodes.children, &chunk->piece);
    }
  }

  // Writes the chunks of a level below the roots. Any worker decodes the next chunk, waits for its
  // turn only to get its place in the file, and then stores it.
  void write_level(uint32_t level, std::span<const ChunkEntry> chunks, DagWriter* writer,
                   WorkArray<uint32_t>* placed) const {
    std::vector<uint64_t> ranks = {1};  // of the first key of each chunk, from 1 on
    for (const ChunkEntry& entry : chunks) ranks.push_back(ranks.back() + entry.nodes);
    std::vector<UnpackedChunk> unpacked(executor_->workers());
    NodeKey last{};  // no key is zero
    Turns turns;
    executor_->for_each(chunks.size(), [&](size_t worker, size_t i) {
      turns.guard([&] {
        check_interrupt();
        encode(level, chunks[i], *writer, &unpacked[worker]);
        LevelPiece& piece = unpacked[worker].piece;
        uint32_t first = 0;  // index
        const bool placed_piece = turns.run(i, [&] {
          require_ascending(last < piece.first, chunks[i]);
          last = piece.last;
          first = writer->append(&piece);
        });
        if (!placed_piece) return;
        for (size_t k = 0; k < piece.indices.size(); ++k)
          (*placed)[ranks[i] + k] = 1 + first + piece.indices[k];
        writer->store(&piece);
      });
    });
  }

  // The nodes of level 0, in any order.
  void write_roots(std::span<const ChunkEntry> chunks, DagWriter* writer) const {
    UnpackedChunk chunk;
    for (const ChunkEntry& entry : chunks) {
      read_nodes(0, entry, &chunk);
      const uint32_t* children = chunk.nodes.children.data();
      for (const unsigned char mask : chunk.nodes.masks) {
        require_ascending(mask != 0, entry);
        writer->add_node(key_of(mask, children));
        children += kChildCounts[mask];
      }
    }
  }

  // Replaces ranks by indices, which keeps the order.
  void place(std::span<uint32_t> children) const {
    constexpr size_t kAhead = 100;
    for (size_t i = 0; i < children.size(); ++i) {
      if (i + kAhead < children.size()) __builtin_prefetch(&placed_[children[i + kAhead]]);
      children[i] = placed_[children[i]];
    }
  }

  const WorkRoom& room_;
  Executor* executor_;
  File file_;
  InputWatch inputs_;
  PackedHeader header_;
  LayerTable layers_;
  std::vector<ChunkEntry> index_;
  size_t next_chunk_ = 0;
  // [1 + rank]: 1 + index in the plain layout, of the level below; [0]: 0.
  WorkArray<uint32_t> placed_;
};

}  // namespace

bool is_packed(const std::string& path) {
  return begins_with(kPackedMagic, path);
}

namespace {

// The file without its colours, and without a name.
DagFile unpack_nodes(Unpacker* unpacker, const std::string& path, const WorkRoom& room) {
  const Header& h = unpacker->plain();
  DagWriter writer(room.folder + "/plain.svdag", grid_of(h), Rule(h.rule));
  unpacker->run(&writer);
  return writer.finish_unnamed(h.voxels, h.largest_snap, unpacker->layers(), path);
}

// Finishes the copy of the nodes.
DagFile with_colours(Unpacker* unpacker, DagCopy* copy, const std::string& path) {
  unpacker->add_colours(copy);
  unpacker->require_same(copy->header());
  DagFile file = copy->open(path);
  unpacker->require_colours(file);
  return file;
}

}  // namespace

PackedSummary packed_summary(const std::string& path) {
  const Unpacker unpacker(path, {}, nullptr);
  return {unpacker.plain(), unpacker.layers(), File::open_read(path).size()};
}

DagFile unpack(const std::string& path, const WorkRoom& room, Executor* executor) {
  Unpacker unpacker(path, room, executor);
  DagFile nodes = unpack_nodes(&unpacker, path, room);
  if (has_colours(unpacker.plain())) {
    DagCopy copy(nodes, room.folder + "/coloured.svdag");
    return with_colours(&unpacker, &copy, path);
  }
  unpacker.require_same(nodes.header());
  return nodes;
}

Header unpack_to(const std::string& path, const std::string& output, const WorkRoom& room,
                 Executor* executor) {
  Unpacker unpacker(path, room, executor);
  const Header& h = unpacker.plain();
  if (has_colours(h)) {
    DagCopy copy(unpack_nodes(&unpacker, path, room), output);
    with_colours(&unpacker, &copy, path);
    return copy.commit();
  }
  DagWriter writer(output, grid_of(h), Rule(h.rule));
  unpacker.run(&writer);
  writer.finish(h.voxels, h.largest_snap, unpacker.layers(),
                [&](const Header& header) { unpacker.require_same(header); });
  return writer.header();
}

}  // namespace svdag
