// The common body of the fuzz targets of svdag's own files: any bytes are read or give an Error
// with an expected code and a message. The targets repair checksums, not a mutator of libFuzzer, so
// that replaying the corpus without libFuzzer gives the same inputs.
#pragma once

#include <cstdlib>
#include <string>

#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

// Damaged scratch files are kOutput.
template <class Work>
void expect_only_errors(const Work& work, ExitCode damaged = ExitCode::kBadInput) {
  try {
    work();
  } catch (const Error& error) {
    const bool expected = error.code() == damaged || error.code() == ExitCode::kMemory;
    if (!expected || std::string(error.what()).empty()) std::abort();
  }
}

}  // namespace svdag
