#include <bit>
#include <fstream>
#include <sstream>

#include "io/formats/vdb/vdb_trees.h"
#include "streaming/file/atomic_file.h"

namespace svdag {
namespace {

openvdb::Coord coord(const LatticePoint& p) {
  return {openvdb::Int32(p.x), openvdb::Int32(p.y), openvdb::Int32(p.z)};
}

openvdb::Vec3d vector(const Point& p) {
  return {p.x, p.y, p.z};
}

// True if the axes of the voxels are those of the world.
bool is_axis_aligned(const IndexToWorld& centres) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (a != b && centres.axes[size_t(a)][b] != 0) return false;
  return true;
}

// A map of a scale and a translation. All of OpenVDB's constructors convert to a matrix and back,
// which is inexact, above all far from zero, and fails for voxels below 1.45e-5. Reading a map from
// a file is exact, so this writes what ScaleTranslateMap::write would write, and reads it.
openvdb::math::Transform::Ptr scale_translate(const openvdb::Vec3d& scale,
                                              const openvdb::Vec3d& translation) {
  using namespace openvdb::math;
  const bool uniform = scale.x() == scale.y() && scale.x() == scale.z();
  const openvdb::Vec3d inverse = 1.0 / scale, size(Abs(scale.x()), Abs(scale.y()), Abs(scale.z()));
  std::stringstream file;
  openvdb::io::setCurrentVersion(file);
  openvdb::writeString(
      file, uniform ? UniformScaleTranslateMap::mapType() : ScaleTranslateMap::mapType());
  for (const openvdb::Vec3d& part :
       {translation, scale, size, inverse, inverse * inverse, inverse / 2.0})
    part.write(file);
  const auto transform = std::make_shared<Transform>();
  transform->read(file);
  return transform;
}

openvdb::math::Transform::Ptr transform_of(const IndexToWorld& centres) {
  const auto& axes = centres.axes;
  if (is_axis_aligned(centres))
    return scale_translate({axes[0].x, axes[1].y, axes[2].z}, vector(centres.origin));
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();  // acts on row vectors
  for (int row = 0; row < 3; ++row)
    for (int a = 0; a < 3; ++a) matrix[row][a] = axes[size_t(row)][a];
  for (int a = 0; a < 3; ++a) matrix[3][a] = centres.origin[a];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

// A grid that OpenVDB can write. OpenVDB copies each grid to add metadata, and would convert the
// copy's transform to a matrix; the copy gets the identity instead, as its transform is not used.
template <class GridType>
class WritableGrid final : public GridType {
 public:
  using GridType::copyGrid;
  using GridType::GridType;
  openvdb::GridBase::ConstPtr copyGrid() const override {
    return this->copyReplacingTransform(openvdb::math::Transform::createLinearTransform());
  }
};

// True if the file contains this grid.
template <class GridType>
bool reads_back(openvdb::io::File* file, const GridType& mine) {
  const auto back = openvdb::gridPtrCast<GridType>(file->readGrid(mine.getName()));
  if (!back || !back->transform().isLinear() ||
      centres_of(back->transform()) != centres_of(mine.transform()) ||
      !back->constTree().hasSameTopology(mine.constTree()))
    return false;
  auto value = mine.cbeginValueOn();
  for (auto found = back->cbeginValueOn(); found; ++found, ++value)
    if (*found != *value) return false;
  return true;
}

// Grids of values of the voxels; null: none.
struct ValueGrids {
  openvdb::Int32Grid::Ptr labels;
  openvdb::Vec3SGrid::Ptr colours;
};

// Writes the grids, and those of values, if there are any.
template <class GridType>
void write_grids(const std::string& path, openvdb::GridPtrVec grids, const ValueGrids& values) {
  const size_t count = grids.size();
  if (values.labels) grids.push_back(values.labels);
  if (values.colours) grids.push_back(values.colours);
  openvdb::io::File(path).write(grids);
  openvdb::io::File file(path);
  file.setCopyMaxBytes(0);
  file.open(/*delayLoad=*/false);
  bool same = (!values.labels || reads_back(&file, *values.labels)) &&
              (!values.colours || reads_back(&file, *values.colours));
  for (size_t i = 0; i < count; ++i)
    same = same && reads_back(&file, static_cast<const GridType&>(*grids[i]));
  if (!same) throw openvdb::IoError("reads back differently");
}

// Writes the grids with values of another type: 1 (true) where `masks` are active, else 0 (false).
template <class GridType>
void write_as(const std::string& path, const std::vector<openvdb::MaskGrid::Ptr>& masks,
              openvdb::GridClass grid_class, const ValueGrids& values) {
  using Value = typename GridType::ValueType;
  openvdb::GridPtrVec grids;
  for (const openvdb::MaskGrid::Ptr& mask : masks) {
    const auto tree = std::make_shared<typename GridType::TreeType>(
        mask->tree(), Value(0), Value(1), openvdb::TopologyCopy());
    const auto grid = std::make_shared<WritableGrid<GridType>>(tree);
    grid->insertMeta(*mask);
    grid->setTransform(mask->transformPtr());
    grid->setGridClass(grid_class);
    grids.push_back(grid);
  }
  write_grids<GridType>(path, std::move(grids), values);
}

class Writer final : public VdbWriter {
 public:
  void begin(const std::string& name, const IndexToWorld& centres) override {
    const auto grid = std::make_shared<WritableGrid<openvdb::MaskGrid>>(false);
    grid->setName(name);
    grid->setTransform(transform_of(centres));
    grids_.push_back(grid);
  }

  void metadata(const VdbMetadata& entries) override {
    openvdb::GridBase* grid = grids_.back().get();
    if (values_.labels) grid = values_.labels.get();
    if (values_.colours) grid = values_.colours.get();
    for (const auto& [key, value] : entries) grid->insertMeta(key, openvdb::StringMetadata(value));
  }

  void add(const VoxelCube& cube) override {
    openvdb::MaskTree& tree = grids_.back()->tree();
    if (cube.side > kBlockSide || cube.block == Block::full()) {
      const LatticePoint last = cube.origin + (cube.side - 1);
      return tree.sparseFill({coord(cube.origin), coord(last)}, true, true);
    }
    openvdb::MaskTree::LeafNodeType& leaf = *tree.touchLeaf(coord(cube.origin));
    openvdb::util::NodeMask<3> mask = leaf.getValueMask();
    for (openvdb::Index x = 0; x < 8; ++x) mask.getWord<uint64_t>(x) |= cube.block.words[x];
    leaf.setValueMask(mask);
  }

  void add_voxel(const LatticePoint& voxel) override {
    grids_.back()->tree().setValueOn(coord(voxel));
  }

  void begin_labels(const std::string& name, const IndexToWorld& centres) override {
    values_.labels = std::make_shared<WritableGrid<openvdb::Int32Grid>>(-1);
    values_.labels->setName(name);
    values_.labels->setTransform(transform_of(centres));
  }

  void add_label(const LatticePoint& origin, int64_t side, int32_t label) override {
    values_.labels->tree().sparseFill({coord(origin), coord(origin + (side - 1))}, label, true);
  }

  void add_labels(const VoxelCube& block, const BlockLabels& labels) override {
    auto& leaf = *values_.labels->tree().touchLeaf(coord(block.origin));
    for_each_bit(block, [&](openvdb::Index at) { leaf.setValueOn(at, labels[at]); });
  }

  void begin_colours(const std::string& name, const IndexToWorld& centres) override {
    values_.colours = std::make_shared<WritableGrid<openvdb::Vec3SGrid>>(openvdb::Vec3s(0));
    values_.colours->setName(name);
    values_.colours->setTransform(transform_of(centres));
  }

  void add_colour(const LatticePoint& origin, int64_t side, const Light& light) override {
    values_.colours->tree().sparseFill({coord(origin), coord(origin + (side - 1))}, vector(light),
                                       true);
  }

  void add_colours(const VoxelCube& block, const BlockColours& colours) override {
    auto& leaf = *values_.colours->tree().touchLeaf(coord(block.origin));
    for_each_bit(block, [&](openvdb::Index at) { leaf.setValueOn(at, vector(colours[at])); });
  }

  void write(const std::string& path, VdbFormat format) override {
    AtomicFile file(path);
    try {
      if (format == VdbFormat::kNano) {
        SVDAG_ASSERT(grids_.size() == 1 && !values_.labels && !values_.colours);
        write_nano(*grids_.front(), file.open_name());
      } else if (format == VdbFormat::kBool) {
        write_as<openvdb::BoolGrid>(file.open_name(), grids_, openvdb::GRID_UNKNOWN, values_);
      } else if (format == VdbFormat::kFloat) {
        write_as<openvdb::FloatGrid>(file.open_name(), grids_, openvdb::GRID_FOG_VOLUME, values_);
      } else {
        write_grids<openvdb::MaskGrid>(file.open_name(), {grids_.begin(), grids_.end()}, values_);
      }
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      throw Error(ExitCode::kOutput, "could not be written completely: is the disk full?", path);
    }
    file.commit();
  }

 private:
  static openvdb::Vec3s vector(const Light& light) { return {light[0], light[1], light[2]}; }
  // Calls visit(64x + 8y + z) for the set voxels of a block.
  template <class Visit>
  static void for_each_bit(const VoxelCube& cube, const Visit& visit) {
    for (openvdb::Index x = 0; x < 8; ++x) {
      for (uint64_t plane = cube.block.words[x]; plane != 0; plane &= plane - 1)
        visit(64 * x + openvdb::Index(std::countr_zero(plane)));
    }
  }

  std::vector<openvdb::MaskGrid::Ptr> grids_;
  ValueGrids values_;
};

}  // namespace

std::unique_ptr<VdbWriter> make_vdb_writer() {
  openvdb::initialize();
  return std::make_unique<Writer>();
}

}  // namespace svdag
