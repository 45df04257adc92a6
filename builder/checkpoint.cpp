#include "builder/checkpoint.h"

#include <algorithm>

#include "streaming/record.h"

namespace svdag {
namespace {

constexpr const char* kName = "journal";
constexpr uint32_t kBake = 1, kSplit = 2, kRun = 3, kSession = 4;
constexpr int kSessionShift = 40;  // numbers of streams that a session may use, log2

void put_stream(const SpillStream& stream, RecordWriter* out) {
  out->put(stream.number);
  out->put(stream.bytes);
  out->put(stream.blocks);
}
SpillStream get_stream(RecordReader* in) {
  SpillStream stream;
  in->get(&stream.number);
  in->get(&stream.bytes);
  in->get(&stream.blocks);
  return stream;
}

template <class Key>
void put_level(const RunLevel<Key>& level, RecordWriter* out) {
  SVDAG_ASSERT(level.spilled);
  put_stream(*level.spilled, out);
}
SplitScene get_split(RecordReader* in) {
  SplitScene split;
  in->get(&split.counts);
  uint64_t bins = 0;
  in->get(&bins);
  for (; bins > 0; --bins) {
    TriangleBin bin;
    in->get(&bin.cube);
    in->get(&bin.range);
    in->get(&bin.triangles);
    bin.stream = get_stream(in);
    split.bins.push_back(std::move(bin));
  }
  return split;
}

BakedRun get_run(RecordReader* in) {
  BakedRun baked;
  uint64_t levels = 0;
  in->get(&levels);
  baked.run.nodes.resize(levels);
  baked.run.bricks.spilled = get_stream(in);
  for (auto& level : baked.run.nodes) level.spilled = get_stream(in);
  in->get(&baked.roots);
  in->get(&baked.voxels);
  in->get(&baked.finished);
  return baked;
}

// What the streams of an earlier process take.
struct Extent {
  uint32_t blocks = 0;
  void grow(const SpillStream& stream) {
    for (const uint32_t block : stream.blocks) blocks = std::max(blocks, block + 1);
  }
};

}  // namespace

bool Checkpoint::exists(const ScratchDir& folder) {
  return folder.has(kName);
}

std::optional<SavedBake> Checkpoint::resume() {
  std::vector<JournalRecord> records;
  Journal journal(scratch_->folder()->open(kName), &records);
  SavedBake saved;
  size_t block_bytes = 0;
  Extent triangles, runs;
  uint64_t sessions = 0;
  for (const JournalRecord& record : records) {
    RecordReader in(record.payload);
    if (record.kind == kBake) {
      in.get(&saved.description);
      in.get(&saved.grid);
      in.get(&block_bytes);
    } else if (record.kind == kSplit) {
      saved.split = get_split(&in);
      for (const TriangleBin& bin : saved.split->bins) triangles.grow(bin.stream);
    } else if (record.kind == kRun) {
      saved.runs.push_back(get_run(&in));
      runs.grow(*saved.runs.back().run.bricks.spilled);
      for (const auto& level : saved.runs.back().run.nodes) runs.grow(*level.spilled);
    } else if (record.kind == kSession) {
      ++sessions;
    }
  }
  if (block_bytes == 0) return {};
  // Blocks that a killed process left behind carry numbers that are not in the journal: each
  // session has numbers of its own.
  scratch_->resume(block_bytes, triangles.blocks, runs.blocks,
                   (sessions + 1) << kSessionShift);
  journal_.emplace(std::move(journal));
  append(kSession, RecordWriter());
  return saved;
}

void Checkpoint::discard() {
  journal_.reset();
  if (!exists(*scratch_->folder())) return;
  scratch_->folder()->remove(kName);
  scratch_->folder()->sync();
}

void Checkpoint::begin(const std::string& description, const Grid& grid) {
  const std::lock_guard lock(mutex_);
  if (journal_) return;
  std::vector<JournalRecord> none;
  journal_.emplace(scratch_->folder()->create(kName), &none);
  RecordWriter record;
  record.put(description);
  record.put(grid);
  record.put(scratch_->block_bytes());
  journal_->append(kBake, record.bytes());
  scratch_->folder()->sync();
  scratch_->folder()->sync_itself();
}

void Checkpoint::save_split(const SplitScene& split) {
  scratch_->triangles()->sync();
  RecordWriter record;
  record.put(split.counts);
  record.put(uint64_t(split.bins.size()));
  for (const TriangleBin& bin : split.bins) {
    record.put(bin.cube);
    record.put(bin.range);
    record.put(bin.triangles);
    put_stream(bin.stream, &record);
  }
  append(kSplit, record);
}

void Checkpoint::save_run(const BakedRun& baked) {
  scratch_->runs()->sync();
  RecordWriter record;
  record.put(uint64_t(baked.run.nodes.size()));
  put_level(baked.run.bricks, &record);
  for (const auto& level : baked.run.nodes) put_level(level, &record);
  record.put(baked.roots);
  record.put(baked.voxels);
  record.put(baked.finished);
  append(kRun, record);
}

void Checkpoint::append(uint32_t kind, const RecordWriter& record) {
  const std::lock_guard lock(mutex_);
  journal_->append(kind, record.bytes());
}

}  // namespace svdag
