// The metadata of a `.svdag` file: the header as one line of JSON (docs/format.md, "Metadata").
#pragma once

#include <string>

#include "io/dag/format.h"

namespace svdag {

// The metadata line of a file with this header, which must be valid.
std::string metadata_of(const Header& header);

}  // namespace svdag
