// The common body of the readers' fuzz targets: any bytes are a scene or an Error (bad input or
// memory; with a time also usage: there may be no animation).
#pragma once

#include <cstdlib>

#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

constexpr uint64_t kReaderMemory = uint64_t(64) << 20;
constexpr uint64_t kDecoderMemory = uint64_t(256) << 20;  // of formats that are decoded as a whole

inline int fuzz_reader(MeshReader reader, const uint8_t* data, size_t size,
                       uint64_t limit = kReaderMemory, const PoseTime* time = nullptr) {
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  MemoryBudget budget(limit);
  const NameFilter names;
  try {
    ReadOptions options{&names, false, &budget};
    options.time = time;
    AlphaImages alpha(&budget, false);
    options.alpha = &alpha;
    read_meshes(reader, memory.file(), options, [](const TriangleBatch& batch) {
      if (batch.triangles.empty() || batch.triangles.size() > BatchWriter::kBatch) std::abort();
      if (batch.texture.size() != (batch.cut == nullptr ? 0 : batch.triangles.size())) std::abort();
    });
  } catch (const Error& error) {
    const bool expected = error.code() == ExitCode::kBadInput ||
                          error.code() == ExitCode::kMemory ||
                          (time != nullptr && error.code() == ExitCode::kUsage);
    if (!expected || std::string(error.what()).empty()) std::abort();
  }
  if (budget.used() != 0) std::abort();
  return 0;
}

}  // namespace svdag
