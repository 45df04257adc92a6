// The content hash of a `.svdag` or `.run` file, which its header stores.
#pragma once

#include <string>

namespace svdag {

// 32 hex digits; of a file with colours, a "+" and their hash follow. Reads only the header and
// checks the length, or proves the hash over every byte if `thorough`. Error (kBadInput) for a
// broken file.
std::string content_hash_of(const std::string& path, bool thorough);

}  // namespace svdag
