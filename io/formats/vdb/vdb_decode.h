// What of a .vdb is read by OpenVDB, in a limited child (vdb_child.cpp), without its headers.
#pragma once

#include <span>

#include "io/formats/vdb.h"
#include "streaming/process/limited_child.h"

namespace svdag {

// Sends the grid requested from read_vdb() out of the bytes of the file `path`, as described in
// io/formats/sent_cubes.h. Opens no file and starts no thread. Must run in a process that exits
// afterwards: OpenVDB's data is never freed, since its trees free themselves with threads.
void decode_vdb(const std::string& path, std::span<const std::byte> bytes, const std::string& name,
                const std::optional<ValueRange>& range, const BlockSink& send);

}  // namespace svdag
