// What decides the bytes of a bake, as text: one "name: value" per line.
//
// A bake may be resumed if and only if its description is the same. Threads, memory and cells are
// no part of it.
#pragma once

#include <string>

#include "builder/build.h"

namespace svdag {

// Reads all input files once, for their hashes. Of files that these name (the buffers of a .gltf)
// it knows nothing.
std::string describe(const BuildConfig& config);

// What differs first between two descriptions, for people; empty if nothing does.
std::string difference(const std::string& saved, const std::string& now);

}  // namespace svdag
