// Unpacks gzip files (RFC 1952), of one or several members, with zlib.
//
// Readers need random access, so a scene is unpacked to disk, into a file without a name.
// Rejected: inflating on the fly (every pass would inflate again, and PLY reads two ranges at
// once), unpacking into memory (scenes are larger).
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "streaming/file/file.h"

namespace svdag {

// Whether the file begins as a gzip file.
bool is_gzip(const File& file);

// The first bytes of the content, at most out.size(); returns their number. 0 for damaged data.
size_t unpack_start(const File& file, std::span<std::byte> out);

// Writes the content of `file` to `out`. Damaged data is an Error (kBadInput).
void unpack_gzip(const File& file, File* out);

}  // namespace svdag
