// Reads a scene file given as a string: what the specifications of the readers are written with.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "io/scene/polygons/mesh_writer.h"
#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {

using Corners = std::array<std::array<double, 3>, 3>;

// The halves of the unit square in the plane z = 0.
constexpr Corners kLower = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}};
constexpr Corners kUpper = {{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

struct Reading {
  std::vector<Corners> triangles;
  std::vector<std::string> meshes;  // of each triangle
  uint64_t peak = 0;                // bytes reserved in the budget
};

inline Corners corners_of(const Triangle& t) {
  Corners corners;
  for (int k = 0; k < 3; ++k) corners[k] = {t.v[k].x, t.v[k].y, t.v[k].z};
  return corners;
}

inline Reading read(MeshReader reader, std::string_view bytes, const NameFilter& names = {},
                    uint64_t limit = MemoryBudget::kUnlimited) {
  const MemoryFile memory(bytes);
  MemoryBudget budget(limit);
  Reading reading;
  read_meshes(reader, memory.file(), {&names, false, &budget}, [&](const TriangleBatch& batch) {
    EXPECT_LE(batch.triangles.size(), BatchWriter::kBatch);
    for (const Triangle& t : batch.triangles) {
      reading.triangles.push_back(corners_of(t));
      reading.meshes.emplace_back(batch.mesh);
    }
  });
  reading.peak = budget.peak();
  EXPECT_EQ(budget.used(), 0U) << "a reader gives back what it reserved";
  return reading;
}

// The sentence of the Error that reading must end with; exit code 3 and little memory, always.
inline std::string refusal(MeshReader reader, std::string_view bytes) {
  try {
    read(reader, bytes, {}, uint64_t(16) << 20);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read: " << bytes.substr(0, 200);
  return {};
}

// Every file that is cut short by more than `harmless_tail` bytes is refused.
inline void expect_no_truncation_goes_unnoticed(MeshReader reader, std::string_view bytes,
                                                size_t harmless_tail) {
  ASSERT_FALSE(read(reader, bytes).triangles.empty());
  for (size_t size = 0; size + harmless_tail < bytes.size(); ++size)
    EXPECT_NE(refusal(reader, bytes.substr(0, size)), "") << "cut at " << size;
}

// The bytes of a value in this machine's order (little-endian), or reversed.
template <class T>
std::string raw(T value, bool reversed = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return reversed ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

}  // namespace svdag
