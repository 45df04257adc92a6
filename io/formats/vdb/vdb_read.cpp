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

// A .vdb in memory; only the requested grid is read: OpenVDB's File without the file.
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
    for (int32_t rest = readGridCount(*in_); rest > 0; --rest) read_entry();
    std::stable_sort(grids_.begin(), grids_.end(), [](const GridEntry& a, const GridEntry& b) {
      return a.descriptor.gridName() < b.descriptor.gridName();
    });
  }

  size_t count() const { return grids_.size(); }

  std::string names() const {
    std::string all;
    for (const GridEntry& entry : grids_)
      all +=
          (all.empty() ? "" : ", ") + GridDescriptor::nameAsString(entry.descriptor.uniqueName());
    return all;
  }

  // The grid with this unique name, else the first of this name; null if not found.
  GridBase::Ptr grid(const std::string& name) {
    GridEntry* entry = find(name);
    if (entry == nullptr) return nullptr;
    load(entry);
    if (entry->descriptor.isInstance()) {  // it shares the tree of another grid
      GridEntry* parent =
          find(GridDescriptor::nameAsString(entry->descriptor.instanceParentName()));
      if (parent == nullptr) throw openvdb::KeyError("the grid whose tree it shares is missing");
      load(parent);
      entry->grid->setTree(parent->grid->baseTreePtr());
    }
    return entry->grid;
  }
  // The only grid, or the only one of a supported type; null if there are several.
  GridBase::Ptr only() {
    const GridEntry* found = grids_.size() == 1 ? &grids_[0] : nullptr;
    for (const GridEntry& entry : grids_) {
      const openvdb::Name& type = entry.descriptor.gridType();
      if (grids_.size() == 1 ||
          (type != openvdb::MaskGrid::gridType() && type != openvdb::BoolGrid::gridType() &&
           type != openvdb::FloatGrid::gridType()))
        continue;
      if (found != nullptr) return nullptr;
      found = &entry;
    }
    if (found == nullptr) return nullptr;
    return grid(GridDescriptor::nameAsString(found->descriptor.uniqueName()));
  }

 private:
  struct GridEntry {
    GridDescriptor descriptor;
    GridBase::Ptr grid;
    bool loaded = false;
  };

  void read_entry() {
    GridEntry& entry = grids_.emplace_back();
    entry.grid = entry.descriptor.read(*in_);
    if (!inputHasGridOffsets()) {
      readGrid(entry.grid, entry.descriptor, *in_);
      entry.loaded = true;
      return;
    }
    if (entry.descriptor.getEndPos() < in_->tellg())  // else reading might never end
      throw openvdb::IoError("a grid ends before it begins");
    entry.descriptor.seekToEnd(*in_);
  }

  GridEntry* find(const std::string& name) {
    const std::string unique = GridDescriptor::stringAsUniqueName(name);
    for (GridEntry& entry : grids_)
      if (entry.descriptor.uniqueName() == unique) return &entry;
    for (GridEntry& entry : grids_)
      if (entry.descriptor.gridName() == name) return &entry;
    return nullptr;
  }

  void load(GridEntry* entry) {
    if (entry->loaded) return;
    entry->descriptor.seekToGrid(*in_);
    readGrid(entry->grid, entry->descriptor, *in_);
    entry->loaded = true;
  }

  std::istream* in_;
  openvdb::io::StreamMetadata::Ptr stream_;
  std::vector<GridEntry> grids_;
};

// Predicates for set voxels, per value type.
struct Active {
  static constexpr CubeValueType kType = CubeValueType::kMask;
  template <class Value>
  bool operator()(const Value&, bool active) const {
    return active;
  }
};
struct ActiveAndTrue {
  static constexpr CubeValueType kType = CubeValueType::kBool;
  bool operator()(bool value, bool active) const { return value && active; }
};
struct InRange {
  static constexpr CubeValueType kType = CubeValueType::kFloat;
  ValueRange range;
  bool operator()(float value, bool) const { return value >= range.low && value <= range.high; }
};

CubeHeader cube_header(const std::string& path, CubeValueType type, const GridBase& grid) {
  if (!grid.transform().isLinear())
    fail_input(path, "grid " + grid.getName() + " has a transform that is not linear");
  const IndexToWorld centres = centres_of(grid.transform());
  CubeHeader header{};
  header.type = type;
  for (int a = 0; a < 3; ++a) {
    for (size_t row = 0; row < 3; ++row) header.axes[row][size_t(a)] = centres.axes[row][a];
    header.origin[size_t(a)] = centres.origin[a];
  }
  return header;
}

void send_header(CubeHeader header, std::string name, const BlockSink& send) {
  name.resize(std::min<size_t>(name.size(), CubeHeader::kMaxNameBytes));
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  header.name_bytes = uint32_t(name.size());
  std::vector<std::byte> block(sizeof header + name.size());
  std::copy_n(reinterpret_cast<const std::byte*>(&header), sizeof header, block.begin());
  std::copy_n(reinterpret_cast<const std::byte*>(name.data()), name.size(),
              block.begin() + sizeof header);
  send(block);
}

// Collects records into blocks and sends them.
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
  const CubeHeader header = cube_header(path, IsSet::kType, grid);
  if (is_set(grid.background(), false))
    fail_usage("--iso: the background value of grid " + grid.getName() +
               " is in that range, so infinitely many voxels would be set");
  send_header(header, grid.getName(), send);
  CubeSender out(send);
  auto value = grid.tree().cbeginValueAll();  // tiles only: leaves follow below
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

void send_supported_grid(const std::string& path, const GridBase::Ptr& base,
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
               " is a float grid: give the values that are set with --iso=LOW,HIGH");
  send_grid(path, *floats, InRange{*range}, send);
}

GridBase::Ptr select_grid(const std::string& path, const std::string& name, Archive* archive) {
  archive->open();
  if (archive->count() == 0) fail_input(path, "contains no grid");
  const GridBase::Ptr grid = name.empty() ? archive->only() : archive->grid(name);
  if (!grid && name.empty())
    fail_usage(path + ": contains more than one grid: choose one with --grid: " + archive->names());
  if (!grid)
    fail_usage(path + ": has no grid " + name + ": choose one with --grid: " + archive->names());
  return grid;
}

}  // namespace

void decode_vdb(const std::string& path, std::span<const std::byte> bytes, const std::string& name,
                const std::optional<ValueRange>& range, const BlockSink& send) {
  try {
    openvdb::initialize();
    // Neither is deleted, whatever is thrown, so no tree is freed.
    auto* stream = new MemoryStream(bytes);
    auto* archive = new Archive(stream);
    send_supported_grid(path, select_grid(path, name, archive), range, send);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::ios_base::failure&) {
    fail_input(path,
               "OpenVDB cannot read it: it is truncated, or its counts and offsets are wrong");
  } catch (const std::exception& error) {
    fail_input(path, std::string("OpenVDB cannot read it: ") + error.what());
  }
}

}  // namespace svdag
