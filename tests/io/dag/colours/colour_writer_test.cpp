#include "io/dag/colours/colour_writer.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "io/dag/colours/dag_colours.h"
#include "io/dag/compact/compact_writer.h"
#include "tests/expect_error.h"
#include "tests/io/dag/colours/coloured_voxels.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

std::string bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ColourWriter : public testing::Test {
 protected:
  // The file of `voxels`; compact if chosen.
  std::string geometry(const VoxelSet& voxels, int levels, bool compact = false) {
    const std::string plain = folder_.file("plain.svdag");
    RawFile(raw_dag(test_grid(levels), voxels)).write(plain);
    if (!compact) return plain;
    write_compact(DagFile::open(plain), folder_.file("compact.svdag"), room_);
    return folder_.file("compact.svdag");
  }
  Header write(const std::string& from, const ColourSettings& settings,
               const std::vector<CubeColour>& colours, const std::string& to, size_t part = 1000,
               size_t threads = 1) {
    ParallelExecutor executor(threads);
    return write_coloured(DagFile::open(from), settings, in_parts(colours, part), to, room_,
                          &executor);
  }
  // Every cube of every level shows the colour of the definition, within the error.
  void expect_colours(const std::string& path, const ColouredCubes& cubes, int level,
                      uint32_t error) {
    const DagFile file = DagFile::open(path);
    const DagColours colours(file, &budget_);
    const int levels = int(file.view().levels);
    const int64_t squared = int64_t(error) * error / 65536;
    for (int k = 0; k <= levels; ++k) {
      const int shown = k > level ? level : k - (level - k) % 2;
      const int64_t side = int64_t(1) << k;
      const auto expected =
          shown < 0 ? std::map<uint64_t, uint32_t>() : expected_colours(cubes, level, shown);
      for (int64_t x = 0; x < side; ++x) {
        for (int64_t y = 0; y < side; ++y) {
          for (int64_t z = 0; z < side; ++z) {
            const uint32_t found =
                svdag_colour(colours.view(), uint32_t(k), uint32_t(x), uint32_t(y), uint32_t(z));
            const auto at = expected.find(morton_code(x, y, z) >> 3 * std::max(0, k - shown));
            if (at == expected.end() || at->second == kNoColour) {
              ASSERT_EQ(found, kNoColour) << k;
            } else {
              ASSERT_NE(found, kNoColour) << k;
              ASSERT_LE(squared_distance(found, at->second), squared) << k;
            }
          }
        }
      }
    }
  }

  const TempFolder folder_;
  MemoryBudget budget_;
  const WorkRoom room_{&budget_, folder_.path()};
};

TEST_F(ColourWriter, EveryCubeShowsItsColour) {
  for (const int levels : {3, 4, 5, 6}) {
    const VoxelSet voxels = bodies(levels, uint64_t(levels));
    for (const bool compact : {false, true}) {
      const std::string from = geometry(voxels, levels, compact);
      for (int level = 1; level <= levels; ++level) {
        for (const uint32_t error : {0U, 9U * 256}) {
          const auto cubes = coloured_cubes(voxels, levels, level, mixed_colours(3));
          const std::string to = folder_.file("c.svdag");
          const Header header =
              write(from, {uint32_t(level), error}, source_of(cubes, level, 9), to);
          EXPECT_EQ(header.version, 3U);
          expect_colours(to, cubes, level, error);
        }
      }
    }
  }
}

// The entries by definition, from maps; a value per entry, kChunkEntry for a chunk.
class Definition {
 public:
  Definition(const ColouredCubes& cubes, int level) : cubes_(cubes), level_(level) {
    for (const auto& [code, colour] : cubes) {
      for (int k = 0; k <= level; ++k) codes_[k].insert(code >> 3 * (level - k));
    }
    visit(0, 0, 0);
  }
  std::vector<ColourEntry> entries;

 private:
  uint64_t count(int k, uint64_t code) const {
    if (k == level_) return 1;
    uint64_t sum = (level_ - k) % 2 == 0;
    for (uint64_t c = 0; c < 8; ++c)
      if (codes_.at(k + 1).contains(code << 3 | c)) sum += count(k + 1, code << 3 | c);
    return sum;
  }
  // The one stored colour of a uniform cube.
  std::optional<uint32_t> uniform(int k, uint64_t code) const {
    const int shift = 3 * (level_ - k);
    std::optional<uint32_t> value;
    for (auto at = cubes_.lower_bound(code << shift);
         at != cubes_.end() && at->first >> shift == code; ++at) {
      const GivenColour& given = at->second;
      if (given.has_colour && !given.is_constant) return {};
      uint32_t stored = given.has_colour ? 0 : kNoColour;
      for (size_t c = 0; c < 3 && given.has_colour; ++c)
        stored |= uint32_t(srgb_code(given.linear[c])) << 8 * c;
      if (value && *value != stored) return {};
      value = stored;
    }
    return value;
  }
  void visit(int k, uint64_t code, uint64_t number) {
    if (const auto value = uniform(k, code)) return entries.push_back({number, *value});
    if (count(k, code) <= kChunkColours) return entries.push_back({number, kChunkEntry});
    if ((level_ - k) % 2 == 0)
      entries.push_back({number++, expected_colours(cubes_, level_, k).at(code)});
    for (uint64_t c = 0; c < 8; ++c) {
      if (!codes_.at(k + 1).contains(code << 3 | c)) continue;
      visit(k + 1, code << 3 | c, number);
      number += count(k + 1, code << 3 | c);
    }
  }

  const ColouredCubes& cubes_;
  const int level_;
  std::map<int, std::set<uint64_t>> codes_;
};

TEST_F(ColourWriter, EntriesAreThoseOfTheDefinition) {
  const int levels = 6;
  VoxelSet voxels = bodies(levels, 3);
  add_box(&voxels, {LatticePoint(0), LatticePoint(64, 64, 40)});
  for (const int level : {4, 5, 6}) {
    for (const int64_t side : {1, 7, 32, 64}) {
      const auto cubes = coloured_cubes(voxels, levels, level, mixed_colours(side));
      const std::string to = folder_.file("c.svdag");
      write(geometry(voxels, levels), {uint32_t(level), 0}, source_of(cubes, level, 9), to);
      const DagFile file = DagFile::open(to);
      const Definition definition(cubes, level);
      MemoryBudget budget;
      const DagColours colours(file, &budget);
      ASSERT_EQ(colours.view().entry_count, definition.entries.size());
      for (size_t i = 0; i < definition.entries.size(); ++i) {
        const ColourEntry &found = colours.view().entries[i], &expected = definition.entries[i];
        ASSERT_EQ(found.first, expected.first);
        if ((expected.value & kChunkEntry) != 0) {
          ASSERT_NE(found.value & kChunkEntry, 0U);
        } else {
          ASSERT_EQ(found.value, expected.value);
        }
      }
    }
  }
}

TEST_F(ColourWriter, BytesDoNotDependOnPartsAndThreads) {
  const int levels = 7;
  VoxelSet voxels = bodies(levels, 5);
  add_box(&voxels, {LatticePoint(0, 0, 90), LatticePoint(128, 128, 95)});
  const auto cubes = coloured_cubes(voxels, levels, levels, mixed_colours(20));
  const std::string from = geometry(voxels, levels);
  const ColourSettings settings{uint32_t(levels), 9 * 256};
  write(from, settings, source_of(cubes, levels, 0), folder_.file("a.svdag"));
  const std::string bytes = bytes_in(folder_.file("a.svdag"));
  for (const int joins : {0, 1, 3, 9}) {
    write(from, settings, source_of(cubes, levels, joins), folder_.file("b.svdag"),
          size_t(1 + joins * 100), size_t(1 + joins % 3));
    EXPECT_EQ(bytes_in(folder_.file("b.svdag")), bytes);
  }
}

TEST_F(ColourWriter, GeometryKeepsItsHashAndComesBack) {
  const int levels = 5;
  const VoxelSet voxels = bodies(levels, 8);
  const auto cubes = coloured_cubes(voxels, levels, 4, mixed_colours(4));
  Hash128 hash{};
  for (const bool compact : {false, true}) {
    const std::string from = geometry(voxels, levels, compact), to = folder_.file("c.svdag");
    const Header header = write(from, {4, 0}, source_of(cubes, 4, 2), to);
    const DagFile coloured = DagFile::open(to), plain = DagFile::open(from);
    EXPECT_EQ(to_hex(header.content_hash), to_hex(plain.header().content_hash));
    // The colours do not depend on the layout.
    if (compact) {
      EXPECT_EQ(to_hex(header.colour_hash), to_hex(hash));
    }
    hash = {header.colour_hash[0], header.colour_hash[1]};
    write_without_colours(coloured, folder_.file("d.svdag"));
    EXPECT_EQ(bytes_in(folder_.file("d.svdag")), bytes_in(from));
    copy_colours(plain, coloured, folder_.file("d.svdag"));
    EXPECT_EQ(bytes_in(folder_.file("d.svdag")), bytes_in(to));
    // New colours take the place of the old ones.
    write(to, {4, 0}, source_of(cubes, 4, 0), folder_.file("d.svdag"));
    EXPECT_EQ(bytes_in(folder_.file("d.svdag")), bytes_in(to));
  }
}

TEST_F(ColourWriter, LayersKeepTheUnionsColours) {
  const int levels = 5;
  const std::vector<VoxelSet> sets{bodies(levels, 1), bodies(levels, 2)};
  VoxelSet all = sets[0];
  all.insert(sets[1].begin(), sets[1].end());
  const std::string from = folder_.file("layers.svdag"), to = folder_.file("c.svdag");
  RawFile(raw_layers(test_grid(levels), sets)).write(from);
  const auto cubes = coloured_cubes(all, levels, levels, mixed_colours(3));
  write(from, {uint32_t(levels), 0}, source_of(cubes, levels, 9), to);
  expect_colours(to, cubes, levels, 0);
  EXPECT_EQ(DagFile::open(to).layers().layers.size(), 2U);
}

TEST_F(ColourWriter, EmptyAndPlainFiles) {
  write(geometry({}, 4), {4, 0}, {}, folder_.file("c.svdag"));
  expect_colours(folder_.file("c.svdag"), {}, 4, 0);
  VoxelSet full;
  add_box(&full, {LatticePoint(0), LatticePoint(64)});
  const std::vector<CubeColour> one{{0, 0, true, true, {65535, 0, 30000}}};
  const Header header = write(geometry(full, 6), {6, 0}, one, folder_.file("c.svdag"));
  EXPECT_EQ(header.directory_bytes, sizeof(ColourEntry));
  EXPECT_EQ(header.chunks_bytes, 0U);
  EXPECT_EQ(header.colour_count, 64U * 64 * 64 + 16 * 16 * 16 + 4 * 4 * 4 + 1);
}

TEST_F(ColourWriter, ColoursOfOtherCubesAreAnError) {
  const VoxelSet voxels{{1, 2, 3}, {15, 15, 15}};
  const std::string from = geometry(voxels, 4);
  const auto cubes = coloured_cubes(voxels, 4, 4, [](auto...) {
    return GivenColour{true, false, {1, 2, 3}};
  });
  const auto good = source_of(cubes, 4, 0);
  const auto expect_failure = [&](std::vector<CubeColour> colours) {
    EXPECT_SVDAG_ERROR(write(from, {4, 0}, colours, folder_.file("c.svdag")), ExitCode::kInternal,
                       "colours do not match the DAG");
    EXPECT_FALSE(std::filesystem::exists(folder_.file("c.svdag")));
  };
  expect_failure({});
  expect_failure({good[0]});
  expect_failure({good[1]});
  expect_failure({good[1], good[0]});
  expect_failure({good[0], good[0], good[1]});
  expect_failure({good[0], good[1], good[1]});
  auto other = good;
  other[0].morton ^= 1;
  expect_failure(other);
  expect_failure({CubeColour{0, 0, true, false, {1, 2, 3}}});  // of all cubes, not constant
}

TEST_F(ColourWriter, LimitsOfMemoryAreReported) {
  MemoryBudget small(1 << 20);
  const DagFile file = DagFile::open(geometry({{1, 2, 3}}, 4));
  SequentialExecutor executor;
  const WorkRoom room{&small, folder_.path()};
  const CubeColourSource none = [] { return std::span<const CubeColour>(); };
  EXPECT_SVDAG_ERROR(write_coloured(file, {4, 0}, none, folder_.file("c.svdag"), room, &executor),
                     ExitCode::kMemory, "chunks of colours");
}

}  // namespace
}  // namespace svdag
