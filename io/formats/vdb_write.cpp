#include <fstream>

#include "io/formats/vdb_trees.h"
#include "streaming/atomic_file.h"

namespace svdag {
namespace {

openvdb::Coord coord(const LatticePoint& p) {
  return {openvdb::Int32(p.x), openvdb::Int32(p.y), openvdb::Int32(p.z)};
}

openvdb::math::Transform::Ptr transform_of(const IndexToWorld& centres) {
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();  // acts on row vectors
  for (int row = 0; row < 3; ++row)
    for (int a = 0; a < 3; ++a) matrix[row][a] = centres.axes[size_t(row)][a];
  for (int a = 0; a < 3; ++a) matrix[3][a] = centres.origin[a];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

// Whether the file at `path` says what was to be written.
template <class GridType>
bool reads_back(const std::string& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File file(path);
  file.setCopyMaxBytes(0);
  file.open(/*delayLoad=*/false);
  for (const openvdb::GridBase::Ptr& grid : grids) {
    const auto& mine = static_cast<const GridType&>(*grid);
    const auto back = openvdb::gridPtrCast<GridType>(file.readGrid(mine.getName()));
    if (!back || back->transform() != mine.transform() ||
        !back->constTree().hasSameTopology(mine.constTree()))
      return false;
    for (auto value = back->cbeginValueOn(); value; ++value)
      if (!*value) return false;
  }
  return true;
}

template <class GridType>
void write_grids(const std::string& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File(path).write(grids);
  if (!reads_back<GridType>(path, grids)) throw openvdb::IoError("reads back as something else");
}

openvdb::GridPtrVec as_bool(const std::vector<openvdb::MaskGrid::Ptr>& masks) {
  openvdb::GridPtrVec grids;
  for (const openvdb::MaskGrid::Ptr& mask : masks) {
    const auto tree =
        std::make_shared<openvdb::BoolTree>(mask->tree(), false, true, openvdb::TopologyCopy());
    const auto grid = openvdb::BoolGrid::create(tree);
    grid->insertMeta(*mask);
    grid->setTransform(mask->transformPtr());
    grids.push_back(grid);
  }
  return grids;
}

class Writer final : public VdbWriter {
 public:
  void begin(const std::string& name, const IndexToWorld& centres) override {
    const auto grid = openvdb::MaskGrid::create(false);
    grid->setName(name);
    grid->setTransform(transform_of(centres));
    grids_.push_back(grid);
  }

  void metadata(const VdbMetadata& entries) override {
    for (const auto& [key, value] : entries)
      grids_.back()->insertMeta(key, openvdb::StringMetadata(value));
  }

  void add(const Cube& cube) override {
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

  void write(const std::string& path, VdbFormat format) override {
    AtomicFile file(path);
    try {
      if (format == VdbFormat::kNano) {
        SVDAG_ASSERT(grids_.size() == 1);
        write_nano(*grids_.front(), file.open_name());
      } else if (format == VdbFormat::kBool) {
        write_grids<openvdb::BoolGrid>(file.open_name(), as_bool(grids_));
      } else {
        write_grids<openvdb::MaskGrid>(file.open_name(), {grids_.begin(), grids_.end()});
      }
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      throw Error(ExitCode::kOutput, "could not be written whole: is the disk full?", path);
    }
    file.commit();
  }

 private:
  std::vector<openvdb::MaskGrid::Ptr> grids_;
};

}  // namespace

std::unique_ptr<VdbWriter> make_vdb_writer() {
  openvdb::initialize();
  return std::make_unique<Writer>();
}

}  // namespace svdag
