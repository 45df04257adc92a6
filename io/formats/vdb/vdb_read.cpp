#include <algorithm>
#include <new>
#include <vector>

#include "io/formats/memory_stream.h"
#include "io/formats/sent_cubes.h"
#include "io/formats/vdb/vdb_decode.h"
#include "io/formats/vdb/vdb_trees.h"
#include "streaming/error.h"

namespace svdag {
namespace {

using openvdb::GridBase;
using openvdb::io::GridDescriptor;

// A .vdb in memory, of which only the requested grid is read: OpenVDB's File without the file.
// Files written by a stream store no offsets, so all their grids are read one after the other.
class Archive final : public openvdb::io::Archive {
 public:
  explicit Archive(std::istream* in) : in_(in) { setInputHasGridOffsets(true); }

  void open() {
    readHeader(*in_);
    stream_ = std::make_shared<openvdb::io::StreamMetadata>();
    stream_->setSeekable(true);
    openvdb::io::setStreamMetadataPtr(*in_, stream_, /*transfer=*/false);
    setFormatVersion(*in_);
    setLibraryVersion(*in_);
    setDataCompression(*in_);
    openvdb::MetaMap().readMeta(*in_);
    for (int32_t left = readGridCount(*in_); left > 0; --left) read_entry();
    std::stable_sort(grids_.begin(), grids_.end(), [](const Entry& a, const Entry& b) {
      return a.what.gridName() < b.what.gridName();
    });
  }

  size_t count() const { return grids_.size(); }

  std::string names() const {
    std::string all;
    for (const Entry& entry : grids_)
      all += (all.empty() ? "" : ", ") + GridDescriptor::nameAsString(entry.what.uniqueName());
    return all;
  }

  // By its unique name, else the first of that name; null if not found.
  GridBase::Ptr grid(const std::string& name) {
    Entry* entry = find(name);
    if (entry == nullptr) return nullptr;
    fill(entry);
    if (entry->what.isInstance()) {  // its tree is that of another grid
      Entry* parent = find(GridDescriptor::nameAsString(entry->what.instanceParentName()));
      if (parent == nullptr) throw openvdb::KeyError("the grid whose tree it shares is missing");
      fill(parent);
      entry->grid->setTree(parent->grid->baseTreePtr());
    }
    return entry->grid;
  }
  GridBase::Ptr first() { return grid(GridDescriptor::nameAsString(grids_[0].what.uniqueName())); }

 private:
  struct Entry {
    GridDescriptor what;
    GridBase::Ptr grid;
    bool filled = false;
  };

  void read_entry() {
    Entry& entry = grids_.emplace_back();
    entry.grid = entry.what.read(*in_);
    if (!inputHasGridOffsets()) {
      readGrid(entry.grid, entry.what, *in_);
      entry.filled = true;
      return;
    }
    if (entry.what.getEndPos() < in_->tellg())  // else a file could be read for ever
      throw openvdb::IoError("a grid ends before it begins");
    entry.what.seekToEnd(*in_);
  }

  Entry* find(const std::string& name) {
    const std::string unique = GridDescriptor::stringAsUniqueName(name);
    for (Entry& entry : grids_)
      if (entry.what.uniqueName() == unique) return &entry;
    for (Entry& entry : grids_)
      if (entry.what.gridName() == name) return &entry;
    return nullptr;
  }

  void fill(Entry* entry) {
    if (entry->filled) return;
    entry->what.seekToGrid(*in_);
    readGrid(entry->grid, entry->what, *in_);
    entry->filled = true;
  }

  std::istream* in_;
  openvdb::io::StreamMetadata::Ptr stream_;
  std::vector<Entry> grids_;
};

// What of a grid is set, by the type of its values.
struct Active {
  static constexpr CubeType kType = CubeType::kMask;
  template <class Value>
  bool operator()(const Value&, bool active) const {
    return active;
  }
};
struct ActiveAndTrue {
  static constexpr CubeType kType = CubeType::kBool;
  bool operator()(bool value, bool active) const { return value && active; }
};
struct InRange {
  static constexpr CubeType kType = CubeType::kFloat;
  ValueRange range;
  bool operator()(float value, bool) const { return value >= range.low && value <= range.high; }
};

CubeHead head_of(const std::string& path, CubeType type, const GridBase& grid) {
  if (!grid.transform().isLinear())
    fail_input(path, "grid " + grid.getName() + " has a transform that is not linear");
  const IndexToWorld centres = centres_of(grid.transform());
  CubeHead head{};
  head.type = type;
  for (int a = 0; a < 3; ++a) {
    for (size_t row = 0; row < 3; ++row) head.axes[row][size_t(a)] = centres.axes[row][a];
    head.origin[size_t(a)] = centres.origin[a];
  }
  return head;
}

void send_head(CubeHead head, std::string name, const BlockSink& send) {
  name.resize(std::min<size_t>(name.size(), CubeHead::kLongestName));
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  head.name_bytes = uint32_t(name.size());
  std::vector<std::byte> block(sizeof head + name.size());
  std::copy_n(reinterpret_cast<const std::byte*>(&head), sizeof head, block.begin());
  std::copy_n(reinterpret_cast<const std::byte*>(name.data()), name.size(),
              block.begin() + sizeof head);
  send(block);
}

// Gathers records into blocks.
class CubeSender {
 public:
  explicit CubeSender(const BlockSink& send) : send_(send) { records_.reserve(kBatch); }
  void add(const openvdb::Coord& origin, int64_t side, const Block& block) {
    records_.push_back({{origin.x(), origin.y(), origin.z()}, uint32_t(side), block.words});
    if (records_.size() == kBatch) flush();
  }
  void flush() {
    if (!records_.empty()) send_(std::as_bytes(std::span(records_)));
    records_.clear();
  }

 private:
  static constexpr size_t kBatch = kChildBlock / sizeof(CubeRecord);

  const BlockSink& send_;
  std::vector<CubeRecord> records_;
};

template <class GridType, class IsSet>
void send_grid(const std::string& path, const GridType& grid, IsSet is_set, const BlockSink& send) {
  const CubeHead head = head_of(path, IsSet::kType, grid);
  if (is_set(grid.background(), false))
    fail_usage("--iso: the background of grid " + grid.getName() +
               " is in that range, so infinitely many voxels would be set");
  send_head(head, grid.getName(), send);
  CubeSender out(send);
  auto value = grid.tree().cbeginValueAll();  // tiles only: leaves are taken whole
  value.setMaxDepth(GridType::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
  for (; value; ++value) {
    if (!is_set(*value, value.isValueOn())) continue;
    const openvdb::CoordBBox box = value.getBoundingBox();
    out.add(box.min(), box.dim().x(), Block::full());
  }
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    Block block;
    for (unsigned bit = 0; bit < 512; ++bit) {
      if (is_set(leaf->getValue(bit), leaf->isValueOn(bit)))
        block.words[bit >> 6] |= uint64_t(1) << (bit & 63);
    }
    if (!block.empty()) out.add(leaf->origin(), kBlockSide, block);
  }
  out.flush();
}

void send_any(const std::string& path, const GridBase::Ptr& base,
              const std::optional<ValueRange>& range, const BlockSink& send) {
  if (const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(base))
    return send_grid(path, *mask, Active(), send);
  if (const auto bools = openvdb::gridPtrCast<openvdb::BoolGrid>(base))
    return send_grid(path, *bools, ActiveAndTrue(), send);
  const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
  if (!floats)
    fail_input(path, "grid " + base->getName() + " holds values of type " + base->valueType() +
                         ", not mask, bool or float");
  if (!range)
    fail_usage(path + ": grid " + base->getName() +
               " is a float grid: say with --iso=LOW,HIGH which values are set");
  send_grid(path, *floats, InRange{*range}, send);
}

GridBase::Ptr pick(const std::string& path, const std::string& name, Archive* archive) {
  archive->open();
  if (archive->count() == 0) fail_input(path, "holds no grid");
  if (name.empty() && archive->count() > 1)
    fail_usage(path + ": holds more than one grid; choose with --grid one of " + archive->names());
  const GridBase::Ptr grid = name.empty() ? archive->first() : archive->grid(name);
  if (!grid) fail_usage(path + ": has no grid " + name + "; it holds " + archive->names());
  return grid;
}

}  // namespace

void decode_vdb(const std::string& path, std::span<const std::byte> bytes, const std::string& name,
                const std::optional<ValueRange>& range, const BlockSink& send) {
  try {
    openvdb::initialize();
    // Neither is ever deleted, whatever is thrown, and so no tree is.
    auto* stream = new MemoryStream(bytes);
    auto* archive = new Archive(stream);
    send_any(path, pick(path, name, archive), range, send);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::ios_base::failure&) {
    fail_input(path, "OpenVDB cannot read it: it is cut off, or its counts and offsets are wrong");
  } catch (const std::exception& error) {
    fail_input(path, std::string("OpenVDB cannot read it: ") + error.what());
  }
}

}  // namespace svdag
