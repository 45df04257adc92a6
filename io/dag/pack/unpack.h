// Unpacks what io/dag/pack/pack.h has packed.
//
// Every chunk is checked before it is decoded, and decodes to no more than the index and the header
// say. The plain file must have the size and the content hash of the header.
#pragma once

#include <string>

#include "io/dag/dag_file.h"
#include "streaming/process/executor.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// Whether the file begins like a packed one. Error (kBadInput) if it cannot be read.
bool is_packed(const std::string& path);

// What a packed file says of itself: no chunk is read.
struct PackedSummary {
  Header plain;  // of the file in the plain layout
  LayerTable layers;
  uint64_t bytes = 0;  // of the packed file
};
PackedSummary packed_summary(const std::string& path);

// The plain file; it has no name and is in room.folder. Error (kBadInput), which names the chunk,
// if the packed file is damaged.
DagFile unpack(const std::string& path, const WorkRoom& room, Executor* executor);

// Writes the plain file to `output` and returns its header.
Header unpack_to(const std::string& path, const std::string& output, const WorkRoom& room,
                 Executor* executor);

}  // namespace svdag
