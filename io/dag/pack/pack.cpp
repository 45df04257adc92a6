#include "io/dag/pack/pack.h"

#include <algorithm>
#include <cstring>

#include "io/dag/pack/node_streams.h"
#include "io/dag/pack/pack_format.h"
#include "io/dag/pack/zstd.h"
#include "io/dag/write/node_starts.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/checksum.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Appends the streams to a chunk: their u32 sizes before and after compression, then the frames.
template <size_t count>
std::vector<std::byte> chunk_of(const std::array<Stream, count>& streams, int level) {
  std::vector<std::byte> chunk(2 * count * sizeof(uint32_t));
  for (size_t i = 0; i < count; ++i) {
    const size_t size = append_zstd(streams[i], level, &chunk);
    const uint32_t sizes[2] = {uint32_t(streams[i].size()), uint32_t(size)};
    std::memcpy(chunk.data() + i * sizeof sizes, sizes, sizeof sizes);
  }
  return chunk;
}

class Packer {
 public:
  Packer(const DagFile& plain, const std::string& path, int level, MemoryBudget* budget,
         Executor* executor)
      : plain_(plain),
        dag_(plain.view()),
        header_(plain.header()),
        zstd_(level),
        budget_(budget),
        executor_(executor),
        file_(path) {
    SVDAG_ASSERT(plain.layout() == Layout::kPlain);
  }

  uint64_t run() {
    file_.write_at(0, std::vector<std::byte>(sizeof(PackedHeader)));
    file_.append(plain_.bytes().subspan(header_.layers_offset, header_.layers_bytes));
    const uint32_t bricks = dag_.brick_level();
    write_level(bricks, header_.sections[bricks].nodes);
    for (uint32_t level = bricks; level-- > 0;) write_level(level, header_.sections[level].nodes);
    write_part(header_.chunks_offset, header_.chunks_bytes);
    write_part(header_.directory_offset, header_.directory_bytes);
    finish();
    return file_.size();
  }

 private:
  struct Chunk {
    uint64_t begin;  // index of its first node
    uint32_t nodes;
    std::vector<std::byte> bytes;
  };

  // Makes chunks of `count` nodes; `skip(index, nodes)` returns the index after these nodes.
  template <class Skip, class Encode>
  void write_chunks(uint64_t count, const Skip& skip, const Encode& encode) {
    uint64_t index = 0;
    std::vector<Chunk> batch;
    for (uint64_t done = 0; done < count;) {
      check_interrupt();
      batch.clear();
      while (done < count && batch.size() < 4 * executor_->workers()) {
        batch.push_back({index, uint32_t(std::min<uint64_t>(kChunkNodes, count - done)), {}});
        done += batch.back().nodes;
        index = skip(index, batch.back().nodes);
      }
      executor_->for_each(batch.size(),
                          [&](size_t, size_t i) { batch[i].bytes = encode(batch[i]); });
      for (const Chunk& chunk : batch) append(chunk);
    }
  }
  // Bricks from `first` on, or what is packed like them.
  void write_bricks(const Brick* first, uint64_t count) {
    write_chunks(
        count, [](uint64_t index, uint32_t bricks) { return index + bricks; },
        [&](const Chunk& chunk) {
          return chunk_of(streams_of_bricks({first + chunk.begin, chunk.nodes}), zstd_);
        });
  }
  // A part of the colours. The zeros after it fill the last brick.
  void write_part(uint64_t offset, uint64_t bytes) {
    write_bricks(reinterpret_cast<const Brick*>(plain_.bytes().data() + offset),
                 bricks_of_bytes(bytes));
  }

  void write_level(uint32_t level, uint64_t nodes) {
    if (level == dag_.brick_level()) return write_bricks(dag_.bricks, nodes);
    const bool inner = level + 1 < dag_.brick_level();
    RankBitmap below(budget_, "numbers of nodes");
    if (inner) below = node_starts(dag_, level + 1, budget_);
    const auto rank = [&](uint32_t index) { return inner ? below.rank(index) : index; };
    write_chunks(
        nodes,
        [&](uint64_t index, uint32_t skipped) {
          while (skipped-- > 0) index = dag_next(dag_, level, index);
          return index;
        },
        [&](const Chunk& chunk) { return node_chunk(level, chunk, rank); });
  }

  template <class Rank>
  std::vector<std::byte> node_chunk(uint32_t level, const Chunk& chunk, const Rank& rank) const {
    std::vector<NodeKey> nodes(chunk.nodes);
    uint64_t index = chunk.begin;
    for (NodeKey& node : nodes) {
      dag_for_children(dag_, level, uint32_t(index),
                       [&](unsigned c, uint32_t child) { node[c] = 1 + rank(child); });
      index = dag_next(dag_, level, index);
    }
    return chunk_of(streams_of_nodes(nodes), zstd_);
  }

  void append(const Chunk& chunk) {
    index_.push_back(
        {file_.size(), checksum64(chunk.bytes), uint32_t(chunk.bytes.size()), chunk.nodes});
    file_.append(chunk.bytes);
  }

  void finish() {
    PackedHeader h{};
    std::memcpy(h.magic, kPackedMagic, sizeof kPackedMagic);
    h.version = packed_version(header_);
    h.chunks = index_.size();
    h.index_offset = file_.size();
    const auto index = std::as_bytes(std::span(index_));
    h.index_checksum = checksum64(index);
    h.plain = header_;
    const auto bytes = std::as_bytes(std::span(&h, 1));
    h.checksum = checksum64(bytes.first(offsetof(PackedHeader, checksum)));
    file_.append(index);
    file_.write_at(0, bytes);
    file_.commit();
  }

  const DagFile& plain_;
  const DagView& dag_;
  const Header& header_;
  int zstd_;
  MemoryBudget* budget_;
  Executor* executor_;
  AtomicFile file_;
  std::vector<ChunkEntry> index_;
};

}  // namespace

uint64_t pack(const DagFile& plain, const std::string& path, int level, MemoryBudget* budget,
              Executor* executor) {
  return Packer(plain, path, level, budget, executor).run();
}

}  // namespace svdag
