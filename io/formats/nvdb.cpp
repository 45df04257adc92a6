#define NANOVDB_USE_OPENVDB
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cstring>
#include <fstream>

#include "io/formats/vdb_trees.h"

namespace svdag {

void write_nano(const openvdb::MaskGrid& grid, const std::string& path) {
  const nanovdb::GridHandle<> handle = nanovdb::openToNanoVDB(grid);
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  nanovdb::io::writeGrid(out, handle, nanovdb::io::Codec::NONE);
  out.close();
  if (!out) throw std::runtime_error("not written whole");
  std::ifstream in(path, std::ios::binary);
  const nanovdb::GridHandle<> back = nanovdb::io::readGrid(in);
  if (back.size() != handle.size() || std::memcmp(back.data(), handle.data(), back.size()) != 0)
    throw std::runtime_error("reads back as something else");
}

}  // namespace svdag
