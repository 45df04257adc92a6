// Unpacks what io/pack/pack.h has packed, and opens files of either kind.
//
// Every chunk is checked before it is decoded, and decodes to no more than the index and the header
// say. The plain file must have the size and the content hash of the header.
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "streaming/process/executor.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// Whether the file begins like a packed one. False for a file that cannot be read.
bool is_packed(const std::string& path);

// The plain file; it has no name and is in room.folder. Error (kBadInput), which names the chunk,
// if the packed file is damaged.
DagFile unpack(const std::string& path, const WorkRoom& room, Executor* executor);

// Writes the plain file to `output` and returns its header.
Header unpack_to(const std::string& path, const std::string& output, const WorkRoom& room,
                 Executor* executor);

// Only these layers of `file`, as a file in room.folder without a name. One alone is a file without
// layers; of several, the first root is their union.
DagFile only_layers(const DagFile& file, const std::vector<std::string>& layers,
                    const WorkRoom& room);

// Opens a .svdag (DagFile::open), or a packed one, which is unpacked to a file without a name. With
// names of layers: only these. `room`: for such files; null: TMPDIR, and half of the memory.
DagFile open_dag(const std::string& path, const std::vector<std::string>& layers = {},
                 const WorkRoom* room = nullptr);

}  // namespace svdag
