#include <cmath>

#include "io/formats/vdb_trees.h"
#include "streaming/error.h"
#include "streaming/file.h"

namespace svdag {
namespace {

// What of a grid is set, by the type of its values.
struct Active {
  static constexpr const char* kType = "mask";
  template <class Value>
  bool operator()(const Value&, bool active) const {
    return active;
  }
};
struct ActiveAndTrue {
  static constexpr const char* kType = "bool";
  bool operator()(bool value, bool active) const { return value && active; }
};
struct InRange {
  static constexpr const char* kType = "float";
  ValueRange range;
  bool operator()(float value, bool) const { return value >= range.low && value <= range.high; }
};

IndexToWorld centres_of(const std::string& path, const openvdb::GridBase& grid) {
  if (!grid.transform().isLinear())
    fail_input(path, "grid " + grid.getName() + " has a transform that is not linear");
  const openvdb::Mat4R matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  IndexToWorld centres;
  for (int a = 0; a < 3; ++a) {
    for (int row = 0; row < 3; ++row) centres.axes[size_t(row)][a] = matrix[row][a];
    centres.origin[a] = matrix[3][a];
  }
  return centres;
}

LatticePoint point(const openvdb::Coord& c) {
  return {c.x(), c.y(), c.z()};
}

template <class GridType, class IsSet>
class ReadGrid final : public VdbGrid {
 public:
  ReadGrid(const std::string& path, typename GridType::Ptr grid, IsSet is_set)
      : grid_(std::move(grid)), is_set_(is_set), centres_(centres_of(path, *grid_)) {
    if (is_set_(grid_->background(), false))
      fail_usage("--iso: the background of grid " + grid_->getName() +
                 " lies in that range, so infinitely many voxels would be set");
    bool any = false;
    visit([&](const Cube& cube) {
      const VoxelBox box = cube.box();
      for (int a = 0; a < 3; ++a) {
        bounds_.min[a] = any ? std::min(bounds_.min[a], box.min[a]) : box.min[a];
        bounds_.max[a] = any ? std::max(bounds_.max[a], box.max[a]) : box.max[a];
      }
      return any = true;
    });
  }

  std::string name() const override { return grid_->getName(); }
  std::string type() const override { return IsSet::kType; }
  const IndexToWorld& centres() const override { return centres_; }
  VoxelBox bounds() const override { return bounds_; }

  bool visit(const CubeSink& sink) const override {
    auto value = grid_->tree().cbeginValueAll();  // tiles only: leaves are taken whole
    value.setMaxDepth(GridType::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
    for (; value; ++value) {
      if (!is_set_(*value, value.isValueOn())) continue;
      const openvdb::CoordBBox box = value.getBoundingBox();
      const int64_t side = box.dim().x();
      if (!sink({point(box.min()), side, side == kBlockSide ? Block::full() : Block()}))
        return false;
    }
    for (auto leaf = grid_->tree().cbeginLeaf(); leaf; ++leaf) {
      Cube cube{point(leaf->origin()), kBlockSide, {}};
      for (unsigned bit = 0; bit < 512; ++bit) {
        if (is_set_(leaf->getValue(bit), leaf->isValueOn(bit)))
          cube.block.words[bit >> 6] |= uint64_t(1) << (bit & 63);
      }
      if (!cube.block.empty() && !sink(cube)) return false;
    }
    return true;
  }

  bool get(const LatticePoint& voxel) const override {
    typename GridType::ValueType value;
    const openvdb::Coord at(int(voxel.x), int(voxel.y), int(voxel.z));
    const bool active = grid_->tree().probeValue(at, value);
    return is_set_(value, active);
  }

 private:
  typename GridType::Ptr grid_;
  IsSet is_set_;
  IndexToWorld centres_;
  VoxelBox bounds_;
};

std::unique_ptr<VdbGrid> wrap(const std::string& path, const openvdb::GridBase::Ptr& base,
                              const std::optional<ValueRange>& range) {
  if (const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(base))
    return std::make_unique<ReadGrid<openvdb::MaskGrid, Active>>(path, mask, Active());
  if (const auto bools = openvdb::gridPtrCast<openvdb::BoolGrid>(base))
    return std::make_unique<ReadGrid<openvdb::BoolGrid, ActiveAndTrue>>(path, bools,
                                                                        ActiveAndTrue());
  const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
  if (!floats)
    fail_input(path, "grid " + base->getName() + " holds values of type " + base->valueType() +
                         ", not mask, bool or float");
  if (!range)
    fail_usage(path + ": grid " + base->getName() +
               " is a float grid: say with --iso=LOW,HIGH which values are set");
  return std::make_unique<ReadGrid<openvdb::FloatGrid, InRange>>(path, floats, InRange{*range});
}

openvdb::GridBase::Ptr pick(const std::string& path, const std::string& name) {
  openvdb::io::File file(path);
  file.setCopyMaxBytes(0);
  file.open(/*delayLoad=*/false);
  std::string names;
  int count = 0;
  for (auto it = file.beginName(); it != file.endName(); ++it, ++count)
    names += (count > 0 ? ", " : "") + *it;
  if (count == 0) fail_input(path, "holds no grid");
  if (name.empty() && count > 1)
    fail_usage(path + ": holds more than one grid; choose with --grid one of " + names);
  if (!name.empty() && !file.hasGrid(name))
    fail_usage(path + ": has no grid " + name + "; it holds " + names);
  return file.readGrid(name.empty() ? file.beginName().gridName() : name);
}

}  // namespace

std::unique_ptr<VdbGrid> read_vdb(const std::string& path, const std::string& name,
                                  const std::optional<ValueRange>& range) {
  File::open_read(path);  // its sentences about what is missing or no file
  openvdb::initialize();
  try {
    return wrap(path, pick(path, name), range);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    fail_input(path, std::string("OpenVDB cannot read it: ") + error.what());
  }
}

}  // namespace svdag
