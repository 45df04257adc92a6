// Helpers on OpenVDB types shared by vdb_read.cpp, vdb_write.cpp and nvdb.cpp.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include "io/formats/vdb.h"
#include "io/openvdb_grids.h"

namespace svdag {

// A linear transform as IndexToWorld, to the last bit. Its affine map cannot be used: OpenVDB
// inverts the matrix of every affine map, which fails for voxels below 1.45e-5.
inline IndexToWorld centres_of(const openvdb::math::Transform& transform) {
  const auto point = [](const openvdb::Vec3d& p) { return Point(p.x(), p.y(), p.z()); };
  IndexToWorld centres;
  centres.origin = point(transform.baseMap()->applyMap(openvdb::Vec3d(0)));
  for (int a = 0; a < 3; ++a) {
    openvdb::Vec3d step(0);
    step[a] = 1;
    centres.axes[size_t(a)] = point(transform.baseMap()->applyJacobian(step));
  }
  return centres;
}

// Writes one grid, with cubic axis-aligned voxels, as .nvdb to the file `path`.
void write_nano(const openvdb::MaskGrid& grid, const std::string& path);

}  // namespace svdag
