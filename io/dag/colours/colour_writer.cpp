#include "io/dag/colours/colour_writer.h"

#include <algorithm>
#include <optional>

#include "io/colour.h"
#include "io/dag/colours/chunk_codec.h"
#include "io/dag/colours/colour_directory.h"
#include "io/dag/colours/dag_colours.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr uint64_t kEncoderBytes = 4 << 20;  // of a worker
constexpr size_t kChunksPerWorker = 16;      // that wait to be encoded
constexpr uint64_t kBytesPerEncoder = kEncoderBytes + kChunksPerWorker * 2 * 4 * kChunkColours;

// Encodes chunks on all workers and appends them in order.
class ChunkQueue {
 public:
  ChunkQueue(uint32_t error, ColourParts* parts, ColourDirectory* directory, MemoryBudget* budget,
             Executor* executor)
      : parts_(parts),
        directory_(directory),
        executor_(executor),
        encoders_(
            encoders_within(*budget, executor->workers()),
            ChunkEncoder(uint32_t(uint64_t(error) * error / kColourErrorUnit / kColourErrorUnit))),
        chunks_(encoders_.size() * kChunksPerWorker),
        reserved_(budget->reserve(encoders_.size() * kBytesPerEncoder, "chunks of colours")) {}

  // Takes the colours, and leaves other memory in their place. `stored`: the words of this chunk,
  // if there are some, instead of an encoding.
  void add(uint64_t first, std::vector<uint32_t>* colours, std::span<const uint32_t> stored) {
    if (used_ == chunks_.size()) encode();
    Chunk& chunk = chunks_[used_++];
    chunk.entry = directory_->add({first, kChunkEntry});
    chunk.colours.swap(*colours);
    chunk.stored = stored;
  }
  void encode() {
    check_interrupt();
    executor_->for_each(std::min(used_, encoders_.size()), [&](size_t, size_t encoder) {
      for (size_t i = encoder; i < used_; i += encoders_.size()) {
        chunks_[i].words.clear();
        if (chunks_[i].stored.empty())
          encoders_[encoder].encode(chunks_[i].colours, &chunks_[i].words);
      }
    });
    for (size_t i = 0; i < used_; ++i) {
      const Chunk& chunk = chunks_[i];
      const auto words = chunk.stored.empty() ? std::span(chunk.words) : chunk.stored;
      directory_->set_value(chunk.entry, kChunkEntry | words_);
      parts_->add_chunks(std::as_bytes(words));
      words_ += words.size();
    }
    used_ = 0;
  }

 private:
  // As many as there are workers, but in the room that is left, and one in any case.
  static size_t encoders_within(const MemoryBudget& budget, size_t workers) {
    const uint64_t room = budget.limit() - std::min(budget.limit(), budget.used());
    return size_t(std::clamp<uint64_t>(room / kBytesPerEncoder, 1, workers));
  }

  struct Chunk {
    uint64_t entry = 0;
    std::vector<uint32_t> colours, words;
    std::span<const uint32_t> stored;
  };

  ColourParts* parts_;
  ColourDirectory* directory_;
  Executor* executor_;
  std::vector<ChunkEncoder> encoders_;
  std::vector<Chunk> chunks_;
  MemoryBudget::Reservation reserved_;
  size_t used_ = 0;
  uint64_t words_ = 0;  // of all chunks so far
};

// The colours of a cube, for the means above it.
struct CubeSum {
  __extension__ using Wide = unsigned __int128;

  bool is_empty = true;
  bool is_uniform = true;
  uint32_t value = kNoColour;  // if uniform
  uint64_t count = 0;          // of cubes of level K with a colour
  Wide linear[3] = {};

  void add(const CubeSum& other) {
    is_uniform = is_uniform && other.is_uniform && (is_empty || value == other.value);
    value = other.value;
    is_empty = false;
    count += other.count;
    for (int c = 0; c < 3; ++c) linear[c] += other.linear[c];
  }
  uint32_t mean() const {
    if (count == 0) return kNoColour;
    uint32_t colour = 0;
    for (int c = 0; c < 3; ++c)
      colour |= uint32_t(srgb_code(uint16_t((2 * linear[c] + count) / (2 * Wide(count))))) << 8 * c;
    return colour;
  }
};

// Walks the DAG and the colours side by side, depth first.
class ColourWalk {
 public:
  ColourWalk(const DagFile& dag, const ColourCountTables& colours, const ColourCountTables& cubes,
             const CubeColourSource& source, const StoredCubes* stored, ColourDirectory* directory,
             ChunkQueue* queue)
      : dag_(dag.view()),
        colours_(colours),
        cubes_(cubes),
        level_(colours.counts().level),
        source_(source),
        stored_(stored),
        directory_(directory),
        queue_(queue) {}

  void run() {
    if (!dag_.empty()) {
      const CubeSum all = walk({}, 0);
      if (all.is_uniform) directory_->add({0, all.value});
    }
    queue_->encode();
    if (next() != nullptr)
      fail("the colour of a cube without set voxels", next()->level, next()->morton);
  }

 private:
  // A cube of more colours than a chunk has, on the way to the current one. It is open once it is
  // known not to be uniform; until then its uniform children wait.
  struct OpenCube {
    uint64_t number;  // of its first colour
    bool has_mean;
    bool is_open = false;
    uint64_t mean_entry = 0;
    std::vector<ColourEntry> waiting{};
  };

  const CubeColour* next() {
    if (at_ == given_.size()) {
      given_ = source_();
      at_ = 0;
    }
    return at_ < given_.size() ? &given_[at_] : nullptr;
  }

  [[noreturn]] void fail(const char* what, uint32_t level, uint64_t morton) const {
    throw Error(ExitCode::kInternal, "colours do not match the DAG: " + std::string(what) +
                                         " (level " + std::to_string(level) + ", Morton code " +
                                         std::to_string(morton) + ")");
  }

  // The mean of a cube with this many colours.
  uint32_t mean(const CoveredCube& cube, uint64_t colours, const CubeSum& sum) const {
    const auto number = stored_number(cube, colours);
    return number ? stored_->colour(*number) : sum.mean();
  }
  std::optional<uint64_t> stored_number(const CoveredCube& cube, uint64_t colours) const {
    if (stored_ == nullptr) return std::nullopt;
    return stored_->unchanged(cube.level, cube.morton, colours);
  }

  // Whether the next colour is that of all covered cubes of `cube`; then takes it.
  bool take(const CoveredCube& cube, CubeSum* sum) {
    const CubeColour* const colour = next();
    if (colour == nullptr) fail("a cube lacks its colour", cube.level, cube.morton);
    if (colour->level != cube.level || colour->morton != cube.morton) {
      if (cube.level == level_) fail("a cube lacks its colour", cube.level, cube.morton);
      return false;
    }
    if (colour->level < level_ && colour->has_colour && !colour->is_constant)
      fail("a colour of several cubes that is not constant", cube.level, cube.morton);
    sum->is_empty = false;
    sum->is_uniform = colour->is_constant || !colour->has_colour;
    if (colour->has_colour) {
      sum->count = cube.level == level_ ? 1 : cubes_.of(cube);
      sum->value = 0;
      for (int c = 0; c < 3; ++c) {
        sum->linear[c] = CubeSum::Wide(colour->linear[c]) * sum->count;
        sum->value |= uint32_t(srgb_code(colour->linear[c])) << 8 * c;
      }
    }
    ++at_;
    return true;
  }

  // Appends the colours of `cube`, which fit into a chunk, to chunk_.
  CubeSum collect(const CoveredCube& cube) {
    CubeSum sum;
    if (take(cube, &sum)) {
      chunk_.resize(chunk_.size() + colours_.of(cube), sum.value);
      return sum;
    }
    const bool has_mean = colours_.counts().own(cube.level) != 0;
    const size_t own = chunk_.size();
    if (has_mean) chunk_.push_back(0);
    for_covered_children(dag_, cube, [&](const CoveredCube& child) { sum.add(collect(child)); });
    if (has_mean) chunk_[own] = mean(cube, chunk_.size() - own, sum);
    return sum;
  }

  // `number`: of the cube's first colour. Adds all entries of a cube that is not uniform.
  CubeSum walk(const CoveredCube& cube, uint64_t number) {
    CubeSum sum;
    if (colours_.of(cube) <= kChunkColours) {
      chunk_.clear();
      sum = collect(cube);
      if (sum.is_uniform) return sum;
      open_all();
      std::span<const uint32_t> stored;
      if (const auto at = stored_number(cube, chunk_.size()))
        stored = stored_->chunk(*at, chunk_.size());
      queue_->add(number, &chunk_, stored);
      return sum;
    }
    if (take(cube, &sum)) return sum;
    const bool has_mean = colours_.counts().own(cube.level) != 0;
    path_.push_back({number, has_mean});
    const size_t depth = path_.size();
    uint64_t at = number + has_mean;
    for_covered_children(dag_, cube, [&](const CoveredCube& child) {
      const CubeSum part = walk(child, at);
      sum.add(part);
      if (part.is_uniform) add_uniform({at, part.value}, sum.is_uniform);
      at += colours_.of(child);
    });
    SVDAG_ASSERT(path_.size() == depth && path_.back().is_open == !sum.is_uniform);
    if (path_.back().is_open && has_mean)
      directory_->set_value(path_.back().mean_entry, mean(cube, at - number, sum));
    path_.pop_back();
    return sum;
  }

  void add_uniform(const ColourEntry& entry, bool may_be_uniform) {
    if (!may_be_uniform) open_all();
    OpenCube& parent = path_.back();
    if (parent.is_open) {
      directory_->add(entry);
    } else {
      parent.waiting.push_back(entry);
    }
  }

  // Adds the entries of all cubes of the path up to the current place.
  void open_all() {
    for (OpenCube& cube : path_) {
      if (cube.is_open) continue;
      cube.is_open = true;
      if (cube.has_mean) cube.mean_entry = directory_->add({cube.number, 0});
      for (const ColourEntry& entry : cube.waiting) directory_->add(entry);
    }
  }

  const DagView& dag_;
  const ColourCountTables& colours_;
  const ColourCountTables& cubes_;
  const uint32_t level_;
  const CubeColourSource& source_;
  const StoredCubes* stored_;
  ColourDirectory* directory_;
  ChunkQueue* queue_;
  std::span<const CubeColour> given_;
  size_t at_ = 0;  // in given_
  std::vector<uint32_t> chunk_;
  std::vector<OpenCube> path_;
};

}  // namespace

uint8_t srgb_code(uint16_t linear) {
  static const std::vector<uint8_t> kCodes = [] {
    std::vector<uint8_t> codes(65536);
    for (uint64_t v = 0; v < codes.size(); ++v)
      codes[v] = code_of_units((v * kWhiteUnits + 32767) / 65535);
    return codes;
  }();
  return kCodes[linear];
}

void add_colours(DagCopy* copy, const DagFile& dag, const ColourSettings& settings,
                 const CubeColourSource& source, const WorkRoom& room, Executor* executor,
                 const StoredCubes* stored) {
  SVDAG_ASSERT(settings.level >= 1 && settings.level <= dag.view().levels &&
               settings.error <= kMaxColourError);
  if (!dag.layers().empty() && !dag.layers().has_union)
    fail_usage(dag.path() + ": layers without their union have no colours");
  const ColourCountTables colours(dag.view(), settings.level, true, room.budget);
  const ColourCountTables cubes(dag.view(), settings.level, false, room.budget);
  ColourParts parts(copy, settings.level, settings.error, colours.total());
  ColourDirectory directory(room.folder);
  {
    ChunkQueue queue(stored == nullptr ? settings.error : 0, &parts, &directory, room.budget,
                     executor);
    ColourWalk(dag, colours, cubes, source, stored, &directory, &queue).run();
  }
  parts.begin_directory();
  directory.visit_all([&](std::span<const std::byte> bytes) { parts.add_entries(bytes); });
  parts.finish();
}

void add_colours_of(DagCopy* copy, const DagFile& coloured) {
  const Header& from = coloured.header();
  SVDAG_ASSERT(has_colours(from) &&
               std::equal(from.content_hash, from.content_hash + 2, copy->header().content_hash));
  ColourParts parts(copy, from.colour_level, from.colour_error, from.colour_count);
  parts.add_chunks(coloured.bytes().subspan(from.chunks_offset, from.chunks_bytes));
  parts.begin_directory();
  parts.add_entries(coloured.bytes().subspan(from.directory_offset, from.directory_bytes));
  parts.finish();
  if (!std::equal(from.colour_hash, from.colour_hash + 2, copy->header().colour_hash))
    fail_input(coloured.path(), "damaged file: its colours do not match their hash",
               offsetof(Header, colour_hash));
}

Header write_coloured(const DagFile& dag, const ColourSettings& settings,
                      const CubeColourSource& source, const std::string& path, const WorkRoom& room,
                      Executor* executor) {
  DagCopy copy(dag, path);
  add_colours(&copy, dag, settings, source, room, executor);
  return copy.commit();
}

Header copy_colours(const DagFile& dag, const DagFile& coloured, const std::string& path) {
  DagCopy copy(dag, path);
  add_colours_of(&copy, coloured);
  return copy.commit();
}

namespace {

// Copies all except the colours.
void strip(const DagFile& coloured, DagCopy* copy) {
  copy->finish();
  if (!std::equal(copy->header().content_hash, copy->header().content_hash + 2,
                  coloured.header().content_hash))
    fail_input(coloured.path(), "damaged file: its nodes do not match its content hash",
               offsetof(Header, content_hash));
}

}  // namespace

Header write_without_colours(const DagFile& coloured, const std::string& path) {
  DagCopy copy(coloured, path);
  strip(coloured, &copy);
  return copy.commit();
}

DagFile without_colours(const DagFile& coloured, const std::string& folder) {
  DagCopy copy(coloured, folder + "/without_colours.svdag");
  strip(coloured, &copy);
  return copy.open(coloured.path());
}

}  // namespace svdag
