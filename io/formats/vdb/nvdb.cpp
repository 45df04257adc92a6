#define NANOVDB_USE_OPENVDB
#include <nanovdb/util/GridChecksum.h>
#include <nanovdb/util/GridStats.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cstring>
#include <fstream>

#include "io/formats/vdb/vdb_trees.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Converts the grid and its transform. NanoVDB's converter inverts the matrix of the transform,
// which fails for voxels below 1.45e-5; so it converts the voxels with the identity, and the
// transform is set here.
nanovdb::GridHandle<> to_nano(const openvdb::MaskGrid& grid) {
  const IndexToWorld centres = centres_of(grid.transform());
  const double size = centres.axes[0].x;
  SVDAG_ASSERT(centres.axes[1].y == size && centres.axes[2].z == size);
  nanovdb::GridHandle<> handle = nanovdb::openToNanoVDB(
      *grid.copyReplacingTransform(openvdb::math::Transform::createLinearTransform()));
  nanovdb::NanoGrid<nanovdb::ValueMask>* nano = handle.grid<nanovdb::ValueMask>();
  SVDAG_ASSERT(nano != nullptr);
  nanovdb::GridData* data = reinterpret_cast<nanovdb::GridData*>(handle.data());
  data->mMap.set(size, centres.origin, 1.0);
  data->mVoxelSize = nanovdb::Vec3R(size);
  nanovdb::gridStats(*nano);  // updates the world bounding box
  nanovdb::updateChecksum(*nano);
  return handle;
}

}  // namespace

void write_nano(const openvdb::MaskGrid& grid, const std::string& path) {
  const nanovdb::GridHandle<> handle = to_nano(grid);
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  nanovdb::io::writeGrid(out, handle, nanovdb::io::Codec::NONE);
  out.close();
  if (!out) throw std::runtime_error("incomplete write");
  std::ifstream in(path, std::ios::binary);
  const nanovdb::GridHandle<> back = nanovdb::io::readGrid(in);
  if (back.size() != handle.size() || std::memcmp(back.data(), handle.data(), back.size()) != 0)
    throw std::runtime_error("reads back differently");
}

}  // namespace svdag
