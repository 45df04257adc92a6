// A SpillSpace in a temporary folder, and what a reader does with it.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"
#include "streaming/spill/scratch_dir.h"
#include "streaming/spill/spill_file.h"
#include "tests/memory_file.h"
#include "tests/temp_folder.h"

namespace svdag {

class TestSpill {
 public:
  explicit TestSpill(uint64_t share, size_t block_bytes = 4096)
      : scratch_(folder_.file("scratch")), block_bytes_(block_bytes) {
    space_.share = share;
    space_.file = [this] { return open(); };
    space_.stream_number = [this] { return ++streams_; };
  }

  const SpillSpace* space() const { return &space_; }
  // Null while nothing was spilled.
  const SpillFile* file() const { return file_.get(); }

 private:
  SpillFile* open() {
    if (!file_) file_ = std::make_unique<SpillFile>(scratch_.create("positions"), block_bytes_);
    return file_.get();
  }

  TempFolder folder_;
  ScratchDir scratch_;
  size_t block_bytes_;
  std::unique_ptr<SpillFile> file_;
  uint64_t streams_ = 0;
  SpillSpace space_;
};

// All that a reader said: of each triangle the bits of its corners, its mesh and its number; and
// the sentence of the Error in the end.
struct Outcome {
  std::vector<uint64_t> triangles;
  std::string error;
  ExitCode code = ExitCode::kOk;

  bool operator==(const Outcome&) const = default;
};

inline Outcome outcome_of(MeshReader reader, const File& file, MemoryBudget* budget,
                          const SpillSpace* spill = nullptr) {
  const NameFilter names{{}, {"hidden"}};
  Outcome outcome;
  const auto sink = [&](const TriangleBatch& batch) {
    for (size_t k = 0; k < batch.triangles.size(); ++k) {
      for (const Point& p : batch.triangles[k].v) {
        for (int a = 0; a < 3; ++a) outcome.triangles.push_back(std::bit_cast<uint64_t>(p[a]));
      }
      outcome.triangles.push_back(std::hash<std::string_view>()(batch.mesh) ^
                                  3 * std::hash<std::string_view>()(batch.material));
      outcome.triangles.push_back(batch.first + k);
    }
  };
  try {
    read_meshes(reader, file, {&names, false, budget, spill}, sink);
  } catch (const Error& error) {
    outcome.error = error.what();
    outcome.code = error.code();
  }
  return outcome;
}

// Reads `bytes` in memory and with `share`: the same is said, within the share. `beside`: memory
// that the format needs for other things.
inline Outcome expect_same_when_spilled(MeshReader reader, const std::string& bytes, uint64_t share,
                                        uint64_t beside = 1 << 15) {
  const MemoryFile memory(bytes);
  MemoryBudget plenty, little(share + beside);
  const Outcome expected = outcome_of(reader, memory.file(), &plenty);
  TestSpill spill(share);
  const Outcome spilled = outcome_of(reader, memory.file(), &little, spill.space());
  EXPECT_EQ(spilled.error, expected.error);
  EXPECT_EQ(spilled.code, expected.code);
  EXPECT_TRUE(spilled.triangles == expected.triangles)
      << spilled.triangles.size() / 11 << " triangles for " << expected.triangles.size() / 11;
  EXPECT_EQ(little.used(), 0U);
  return expected;
}

}  // namespace svdag
