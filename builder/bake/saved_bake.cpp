#include "builder/bake/saved_bake.h"

#include <algorithm>

#include "builder/colours/spilled_colours.h"
#include "builder/split/bin_record.h"
#include "builder/workspace/scratch.h"

namespace svdag {
namespace {

// Changes when any record does, those of builder/split/bin_record.h included, or the code of bins.
// Journals without a layout begin with the length of their description instead, a text of several
// lines.
constexpr uint32_t kLayout = 10;

// Writes a field in a form without padding or bool.
struct PutField {
  RecordWriter* out;

  template <class T>
  void operator()(const char*, const T& value) const {
    out->put(value);
  }
  void operator()(const char*, Grid::Kind kind) const { out->put(uint32_t(kind)); }
  void operator()(const char*, bool value) const { out->put(uint32_t(value)); }
  void operator()(const char*, const Affine& a) const {
    for (const auto& row : a.m) {
      for (const double v : row) out->put(v);
    }
  }
  void operator()(const char*, const Point& point) const {
    for (int a = 0; a < 3; ++a) out->put(point[a]);
  }
};

// Reads what PutField wrote: no byte of a hostile file becomes a bool or an enumerator unchecked.
struct GetField {
  RecordReader* in;

  template <class T>
  void operator()(const char*, T& value) const {
    in->get(&value);
  }
  void operator()(const char*, Grid::Kind& kind) const {
    uint32_t value = 0;
    in->get(&value);
    kind =
        Grid::Kind(std::min<uint32_t>(value, std::size(kGridKindNames)));  // is_valid() checks it
  }
  void operator()(const char*, bool& value) const { value = flag(); }
  void operator()(const char*, Affine& a) const {
    for (auto& row : a.m) {
      for (double& v : row) in->get(&v);
    }
  }
  void operator()(const char*, Point& point) const {
    for (int a = 0; a < 3; ++a) in->get(&point[a]);
  }

 private:
  bool flag() const {
    uint32_t value = 0;
    in->get(&value);
    in->require(value <= 1, "impossible grid");
    return value == 1;
  }
};

void get_bake(RecordReader* in, const std::string& path, SavedBake* saved) {
  uint32_t layout = 0;
  in->get(&layout);
  if (layout != kLayout)
    throw Error(ExitCode::kUsage, "is of another version of svdag: discard it with --restart",
                path);
  in->get(&saved->description);
  visit_fields(saved->grid, GetField{in});
  in->require(saved->grid.is_valid(), "impossible grid");
  in->get(&saved->block_bytes);
  in->require(Scratch::is_block_size(saved->block_bytes), "impossible size of blocks");
}

void grow(uint32_t* blocks, const SpillStream& stream) {
  for (const uint32_t block : stream.blocks) *blocks = std::max(*blocks, block + 1);
}

// The ranges and roots of a run are in the grid, and each root's rank exists in its level.
void check_run(const BakedRun& baked, int levels, const RecordReader& in) {
  const uint64_t all = uint64_t(1) << 3 * levels;
  for (const MortonRange& range : baked.finished)
    in.require(range.begin <= range.end && range.end <= all, "a run is not in the grid");
  for (const SubDagRoot& root : baked.roots) {
    in.require(root.level >= 0 && root.level <= levels - 2 && root.morton >> 3 * root.level == 0,
               "a root is not in the grid");
    const bool brick = root.level == levels - 2;
    const uint64_t keys =
        brick ? baked.run.bricks.spilled->bytes / sizeof(Brick)
              : baked.run.nodes[size_t(root.level)].spilled->bytes / sizeof(NodeKey);
    in.require(root.rank < keys, "a root has no node");
    in.require(root.sets.subject <= kMaxLayers, "a root is of no layer");
  }
}

constexpr uint32_t kNotInUnion = 0x80000000U;  // flag of the sets of a root, beside the subject

template <class Key>
RunLevel<Key> get_level(RecordReader* in) {
  RunLevel<Key> level;
  level.spilled = get_stream(in);
  in->require(level.spilled->bytes % sizeof(Key) == 0, "a level ends within a node");
  return level;
}

// `run` is not set in them.
std::vector<SubDagRoot> get_roots(RecordReader* in) {
  std::vector<SubDagRoot> roots;
  uint64_t count = 0;
  for (in->get(&count); count > 0; --count) {
    SubDagRoot& root = roots.emplace_back();
    in->get(&root.morton);
    in->get(&root.level);
    in->get(&root.rank);
    uint32_t sets = 0;
    in->get(&sets);
    root.sets = {sets & ~kNotInUnion, (sets & kNotInUnion) == 0};
  }
  return roots;
}

void put_roots(const std::vector<SubDagRoot>& roots, RecordWriter* out) {
  out->put(uint64_t(roots.size()));
  for (const SubDagRoot& root : roots) {
    out->put(root.morton);
    out->put(root.level);
    out->put(root.rank);
    out->put(root.sets.subject | (root.sets.in_union ? 0 : kNotInUnion));
  }
}

BakedRun get_run(RecordReader* in, int levels) {
  BakedRun baked;
  uint64_t nodes = 0;
  in->get(&nodes);
  in->require(nodes + 2 == uint64_t(levels), "a run has other levels than the grid");
  baked.run.nodes.resize(nodes);
  baked.run.bricks = get_level<Brick>(in);
  for (auto& level : baked.run.nodes) level = get_level<NodeKey>(in);
  baked.roots = get_roots(in);
  in->get(&baked.voxels);
  in->get(&baked.layer_voxels);
  in->require(baked.layer_voxels.size() <= kMaxLayers, "more layers than there may be");
  in->get(&baked.finished);
  check_run(baked, levels, *in);
  return baked;
}

void get_colours(RecordReader* in, SavedBake* saved) {
  uint64_t end = 0;
  in->get(&end);
  in->require(saved->coloured <= end && end <= uint64_t(1) << 3 * saved->grid.levels,
              "colours are not in the grid");
  saved->coloured = end;
  const SpillStream& stream = saved->colours.emplace_back(get_stream(in));
  in->require(stream.bytes % SpilledColours::kEntryBytes == 0, "colours end within an entry");
  grow(&saved->run_blocks, stream);
}

template <class Key>
void put_level(const RunLevel<Key>& level, RecordWriter* out) {
  SVDAG_ASSERT(level.spilled);
  put_stream(*level.spilled, out);
}

}  // namespace

RecordWriter bake_record(const std::string& description, const Grid& grid, uint64_t block_bytes) {
  RecordWriter record;
  record.put(kLayout);
  record.put(description);
  visit_fields(grid, PutField{&record});
  record.put(block_bytes);
  return record;
}

RecordWriter split_record(const SplitScene& split) {
  RecordWriter record;
  visit_count_fields(split.counts, PutField{&record});
  put_bins(split.bins, &record);
  put_layers(split.layers, &record);
  put_windings(split.windings.get(), &record);
  put_cut_outs(split.cut_outs, &record);
  return record;
}

RecordWriter run_record(const BakedRun& baked) {
  RecordWriter record;
  record.put(uint64_t(baked.run.nodes.size()));
  put_level(baked.run.bricks, &record);
  for (const auto& level : baked.run.nodes) put_level(level, &record);
  put_roots(baked.roots, &record);
  record.put(baked.voxels);
  record.put(baked.layer_voxels);
  record.put(baked.finished);
  return record;
}

RecordWriter baked_record(const SplitCounts& counts) {
  RecordWriter record;
  visit_count_fields(counts, PutField{&record});
  return record;
}

RecordWriter colours_record(uint64_t end, const SpillStream& entries) {
  RecordWriter record;
  record.put(end);
  put_stream(entries, &record);
  return record;
}

SavedBake read_saved(std::span<const JournalRecord> records, const std::string& path) {
  SavedBake saved;
  for (const JournalRecord& record : records) {
    RecordReader in(record.payload, path, ExitCode::kOutput);
    const SavedKind kind = SavedKind(record.kind);
    in.require((kind == SavedKind::kBake) == (&record == records.data()),
               "it does not begin with the bake");
    if (kind == SavedKind::kBake) {
      get_bake(&in, path, &saved);
    } else if (kind == SavedKind::kSplit) {
      saved.split.emplace();
      visit_count_fields(saved.split->counts, GetField{&in});
      saved.split->bins = get_bins(&in, saved.grid.levels);
      saved.split->layers = get_layers(&in);
      saved.split->windings = get_windings(&in, saved.grid.levels);
      saved.split->cut_outs = get_cut_outs(&in);
      for (const TriangleBin& bin : saved.split->bins) grow(&saved.triangle_blocks, bin.stream);
    } else if (kind == SavedKind::kRun) {
      const Run& run = saved.runs.emplace_back(get_run(&in, saved.grid.levels)).run;
      grow(&saved.run_blocks, *run.bricks.spilled);
      for (const auto& level : run.nodes) grow(&saved.run_blocks, *level.spilled);
    } else if (kind == SavedKind::kBaked) {
      in.require(!saved.baked, "it was baked twice");
      visit_count_fields(saved.baked.emplace(), GetField{&in});
      saved.split.reset();
      saved.runs.clear();
      saved.triangle_blocks = saved.run_blocks = 0;
    } else if (kind == SavedKind::kColours) {
      get_colours(&in, &saved);
    } else {
      in.require(kind == SavedKind::kSession, "a record is of an unknown kind");
      ++saved.sessions;
    }
    in.finish();
  }
  return saved;
}

}  // namespace svdag
