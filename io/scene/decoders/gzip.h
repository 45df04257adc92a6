// Unpacks gzip files (RFC 1952), of one or several members, with zlib.
//
// Readers need random access, so a scene is unpacked to disk, into a file without a name.
// Rejected: inflating on the fly (every pass would inflate again, and PLY reads two ranges at
// once), unpacking into memory (scenes are larger).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "streaming/file/file.h"

namespace svdag {

// Whether the file begins as a gzip file.
bool is_gzip(const File& file);

// The first bytes of the content, at most out.size(); returns their number. 0 for damaged data.
size_t unpack_start(const File& file, std::span<std::byte> out);

struct UnpackRoom {
  std::string folder;  // for errors
  uint64_t max_bytes = std::numeric_limits<uint64_t>::max();
};

// Writes the content of `file` to `out`. Damaged data is an Error (kBadInput), more content than
// there is room for one of kOutput: a small file may expand a thousandfold.
void unpack_gzip(const File& file, File* out, const UnpackRoom& room = {});

}  // namespace svdag
