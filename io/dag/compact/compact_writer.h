// Writes a file in the compact layout (io/dag/compact_view.h) from one in the plain layout.
//
// The layout is written top-down, level by level, because private nodes are in the order of their
// parents, and with the root first. A level takes two passes over the plain section: one counts the
// references to each node of the level below, which decides the classes and thus all sizes; one
// emits the nodes in their new order, which numbers the private nodes of the level below.
//
// Memory: 13 bytes per node of two adjacent levels, in WorkArrays. Everything else is streamed.
//
// Rejected: sorting (number, node) pairs outside of memory (a second sort of the whole DAG, for
// files whose levels do not fit in memory at 13 bytes per node).
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// Writes a valid plain file to `path` in the compact layout, and returns the new header.
Header write_compact(const DagFile& plain, const std::string& path, const WorkRoom& room);

// The same as a file without a name; errors show `shown_as`.
DagFile compact_form(const DagFile& plain, const std::string& shown_as, const WorkRoom& room);

// Whether `compact` has the bytes that write_compact() would write.
bool is_compact_form(const DagFile& compact, const DagFile& plain, const WorkRoom& room);

// [level]: what the sections of a plain file would take in the compact layout, in bytes.
std::vector<uint64_t> compact_section_bytes(const DagView& view, const WorkRoom& room);
// [level]: what the sections of a compact file would take in the plain layout.
std::vector<uint64_t> plain_section_bytes(const DagView& view);

}  // namespace svdag
