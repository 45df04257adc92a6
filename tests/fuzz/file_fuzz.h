// The common body of the fuzz targets of our own files: any bytes are read, or an Error of one of
// the expected codes with a sentence, and nothing else. Checksums are repaired by the targets
// rather than by a mutator of libFuzzer: so the corpus means the same where it is replayed without.
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
