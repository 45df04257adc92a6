// What vdb_read.cpp, vdb_write.cpp and nvdb.cpp share: OpenVDB's types and their errors as ours.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include "io/formats/vdb.h"

namespace svdag {

// A .nvdb of one grid, into a file that `path` opens.
void write_nano(const openvdb::MaskGrid& grid, const std::string& path);

}  // namespace svdag
