// The readers of point files. Headers are not trusted: every count is checked against the size of
// the file before it is used. Errors: kBadInput. The file must outlive the cloud.
#pragma once

#include <memory>

#include "io/formats/points/point_cloud.h"
#include "streaming/file/file.h"

namespace svdag {

// LAS 1.0 to 1.4, point formats 0 to 10 (ASPRS). LAZ, the compressed form, is rejected.
std::unique_ptr<PointCloud> open_las(const File& file);
// A line of text for each point: x y z. A first line of six numbers, of which the last three are
// whole and 0 to 255, gives every point a colour.
std::unique_ptr<PointCloud> open_xyz(const File& file);
// The Point Cloud Library's PCD 0.7, ascii and binary.
std::unique_ptr<PointCloud> open_pcd(const File& file);
// The vertices of a PLY file; those of an exported one have a grid. has_only_points(): whether it
// has no faces.
bool has_only_points(const File& ply);
std::unique_ptr<PointCloud> open_ply_points(const File& file);

}  // namespace svdag
