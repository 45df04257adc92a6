// The common body of the readers' fuzz targets: any bytes are a scene or an Error (bad input or
// memory; with a time also usage: there may be no animation).
#pragma once

#include <cstdlib>

#include "io/scene/colours/linear_images.h"
#include "io/scene/cutouts/alpha_images.h"
#include "io/scene/decoders/image.h"
#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

constexpr uint64_t kReaderMemory = uint64_t(64) << 20;
constexpr uint64_t kDecoderMemory = uint64_t(256) << 20;  // of formats that are decoded as a whole

inline void fuzz_reading(MeshReader reader, const File& file, uint64_t limit, const PoseTime* time,
                         bool is_painted) {
  MemoryBudget budget(limit);
  const NameFilter names;
  try {
    ReadOptions options{&names, false, &budget};
    options.time = time;
    AlphaImages alpha(&budget, false);
    options.alpha = &alpha;
    LinearImages images(&budget, false, LinearImages::Detail::kWhole);
    if (is_painted) options.images = &images;
    if (is_painted) options.paints = &images;
    read_meshes(reader, file, options, [](const TriangleBatch& batch) {
      const size_t triangles = batch.triangles.size();
      if (triangles == 0 || triangles > BatchWriter::kBatch) std::abort();
      const bool is_textured = batch.cut != nullptr || batch.paint != nullptr;
      if (batch.texture.size() != (is_textured ? triangles : 0)) std::abort();
      if (batch.corner_colours.size() != (batch.paint != nullptr ? triangles : 0)) std::abort();
    });
  } catch (const Error& error) {
    const bool expected = error.code() == ExitCode::kBadInput ||
                          error.code() == ExitCode::kMemory ||
                          (time != nullptr && error.code() == ExitCode::kUsage);
    if (!expected || std::string(error.what()).empty()) std::abort();
  }
  if (budget.used() != 0) std::abort();
}

inline int fuzz_reader(MeshReader reader, const uint8_t* data, size_t size,
                       uint64_t limit = kReaderMemory, const PoseTime* time = nullptr) {
  const MemoryFile memory(std::as_bytes(std::span(data, size)));
  for (const bool is_painted : {false, true})
    fuzz_reading(reader, memory.file(), limit, time, is_painted);
  return 0;
}

}  // namespace svdag
