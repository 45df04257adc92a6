// The part of reading a .vdb that runs in a limited child process (vdb_child.cpp); declared without
// OpenVDB's headers.
#pragma once

#include <span>

#include "io/formats/vdb.h"
#include "streaming/process/limited_child.h"

namespace svdag {

// Decodes the grid that read_vdb() requests from the bytes of the file `path` and sends it in the
// format of io/formats/sent_cubes.h. Opens no file and starts no thread. The process must exit
// afterwards: OpenVDB's data is never freed, because its trees free themselves with threads.
void decode_vdb(const std::string& path, std::span<const std::byte> bytes, const std::string& name,
                const std::optional<ValueRange>& range, const BlockSink& send);

}  // namespace svdag
