// The judge of colours: files that the builder colours pass at every level, and each error that is
// planted is found.
#ifdef SVDAG_HAS_IMAGE_DECODERS
#include "verify/colours/colour_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "builder/colour_file.h"
#include "io/dag/colours/dag_colours.h"
#include "tests/builder/bakes.h"
#include "tests/repair_checksums.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"
#include "tests/verify/colours/judged_scenes.h"

namespace svdag {
namespace {

class ColourJudgement : public testing::Test {
 protected:
  static constexpr int kLevels = 6;

  // The block, coloured by `painter`, whose triangles are where those of `block` are.
  ColourComparison judge(const BlockScene& block, const BlockScene& painter,
                         std::optional<int> level = {}, uint32_t error = 0) {
    const std::string scene = write("scene.glb", block.glb());
    BuildConfig config = config_for(scene, folder_.file("plain.svdag"), kLevels);
    config.scene.cut_outs = !painter.is_masked || block.is_masked;
    bake(config);
    ColourFileConfig colours;
    colours.file = config.output;
    colours.scene.paths = {write("painter.glb", painter.glb())};
    colours.pass = {level, error};
    colours.output = folder_.file("painted.svdag");
    SequentialExecutor executor;
    Progress progress;
    colour_file(colours, &executor, &progress);
    return compare(scene, colours.output);
  }
  ColourComparison judge(const BlockScene& block, std::optional<int> level = {},
                         uint32_t error = 0) {
    return judge(block, block, level, error);
  }
  ColourComparison compare(const std::string& path, const std::string& painted) {
    MemoryBudget budget;
    SceneConfig config;
    config.paths = {path};
    config.colours = config.paint = config.keep_images = true;
    const Scene scene(config, &budget);
    Progress progress;
    return compare_colours(scene, DagFile::open(painted), draw_, &budget, &progress);
  }
  std::vector<std::string> defects() {
    MemoryBudget budget;
    return inspect_file(DagFile::open(folder_.file("painted.svdag")), {&budget, folder_.path()})
        .defects;
  }
  std::string write(const std::string& name, const std::string& bytes) {
    const std::string path = folder_.file(name);
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    return path;
  }
  // The last judged file, and its coarser cubes have the means of these colours.
  void expect_right(const ColourComparison& c) {
    EXPECT_EQ(c.wrong, 0u);
    EXPECT_EQ(c.without_triangle, 0u);
    EXPECT_GT(c.judged, c.drawn * 9 / 10);
    EXPECT_EQ(defects(), std::vector<std::string>());
    for (const WrongColour& w : c.worst)
      ADD_FAILURE() << w.cube.x << ' ' << w.cube.y << ' ' << w.cube.z << ": " << std::hex << w.stored << std::dec << " instead of " << w.expected[0]
                    << ' ' << w.expected[1] << ' ' << w.expected[2] << ", allowed " << w.allowed[0]
                    << ' ' << w.allowed[1] << ' ' << w.allowed[2];
  }

  const TempFolder folder_;
  ColourDraw draw_;
};

TEST_F(ColourJudgement, RightColoursPassAtEveryLevelAndError) {
  std::vector<BlockScene> scenes(6);
  scenes[1].factor = {0.9, 0.5, 0.1};
  scenes[1].has_colours = true;
  scenes[2].is_textured = false;
  scenes[2].has_colours = true;
  scenes[3].is_textured = false;
  scenes[3].factor = {0.5, 0.25, 0.9};
  scenes[4].is_masked = true;
  scenes[4].texture.texel = [](int i, int j) {
    const auto texel = ChartTexture().texel(i, j);
    return (i / 3 + j / 3) % 3 == 0 ? std::array<int, 4>{255, 0, 255, 0} : texel;
  };
  scenes[5].sampler = {{"magFilter", 9728}, {"wrapS", 33648}, {"wrapT", 33071}};
  scenes[5].moved = -20;
  for (size_t i = 0; i < scenes.size(); ++i) {
    for (const std::optional<int> level : {std::optional<int>(), {kLevels}, {5}, {4}, {3}}) {
      for (const uint32_t error : {0U, 9 * kColourErrorUnit}) {
        SCOPED_TRACE("scene " + std::to_string(i) + ", level " + std::to_string(level.value_or(0)) +
                     ", error " + std::to_string(error));
        expect_right(judge(scenes[i], level, error));
      }
    }
  }
}

// Foliage, in which a sample of four points is off by many steps.
TEST_F(ColourJudgement, NoisePasses) {
  BlockScene scene;
  std::mt19937 random(1);
  scene.texture.texel = [&](int, int) {
    const int value = random() % 2 == 0 ? 0 : 255;
    return std::array<int, 4>{value, value, int(random() % 256), 255};
  };
  const std::string noise = scene.texture.bytes();
  scene.texture.texel = [&](int i, int j) {
    const uint8_t* const texel = reinterpret_cast<const uint8_t*>(&noise[size_t(4 * (64 * j + i))]);
    return std::array<int, 4>{texel[0], texel[1], texel[2], 255};
  };
  scene.margin = 0;
  for (const int level : {6, 5, 4, 3}) {
    SCOPED_TRACE(level);
    const ColourComparison c = judge(scene, level);
    expect_right(c);
    EXPECT_GT(c.mean_allowed, 5);
  }
}

TEST_F(ColourJudgement, ATextureUpsideDownIsFound) {
  BlockScene painter;
  painter.texture.texel = [](int i, int j) {
    return ChartTexture().texel(i, ChartTexture::kSide - 1 - j);
  };
  EXPECT_GT(judge({}, painter).wrong, 1000u);
  EXPECT_GT(judge({}, painter, {}, 9 * kColourErrorUnit).wrong, 1000u);
  EXPECT_GT(judge({}, painter, 4).wrong, 0u);
}

TEST_F(ColourJudgement, HalfATexelIsFound) {
  BlockScene block, painter;
  block.texture.texel = painter.texture.texel = [](int i, int j) {
    return std::array<int, 4>{16 * (i % 16), 16 * (15 - i % 16), 3 * j, 255};
  };
  painter.moved = 0.5;
  const ColourComparison right = judge(block), wrong = judge(block, painter);
  expect_right(right);
  EXPECT_GT(wrong.wrong, wrong.judged / 2);
}

TEST_F(ColourJudgement, AChartThatBleedsIntoItsNeighbourIsFound) {
  BlockScene block, painter;
  block.margin = 1;
  // The outer two texels of a chart have the colour of the next one, as after a mip map.
  painter.texture.texel = [](int i, int j) {
    const int in = i % ChartTexture::kChart;
    return ChartTexture().texel(in < 2 && i > 2 ? i - 2 : in > 13 && i < 62 ? i + 2 : i, j);
  };
  const ColourComparison wrong = judge(block, painter);
  EXPECT_GT(wrong.wrong, 50u);
  EXPECT_LT(wrong.wrong, wrong.judged / 2);
}

TEST_F(ColourJudgement, LightTakenForSrgbIsFound) {
  BlockScene painter;
  painter.texture.texel = [](int i, int j) {
    auto texel = ChartTexture().texel(i, j);
    for (int c = 0; c < 3; ++c)
      texel[size_t(c)] = int(std::lround(255 * std::pow(texel[size_t(c)] / 255.0, 1 / 2.2)));
    return texel;
  };
  const ColourComparison wrong = judge({}, painter, {}, 9 * kColourErrorUnit);
  EXPECT_GT(wrong.wrong, wrong.judged / 2);
  EXPECT_EQ(wrong.worst.size(), ColourComparison::kShown);
  EXPECT_GT(wrong.worst.front().excess, 20);
}

TEST_F(ColourJudgement, WhatIsCutOutColoursNothing) {
  BlockScene block, painter;
  block.is_masked = true;
  block.texture.texel = painter.texture.texel = [](int i, int j) {
    return (i / 2 + j / 2) % 3 == 0 ? std::array<int, 4>{255, 0, 255, 0}
                                    : std::array<int, 4>{30, 160, 40, 255};
  };
  expect_right(judge(block));
  EXPECT_GT(judge(block, painter).wrong, 100u);
}

TEST_F(ColourJudgement, TheNeighboursColourIsFound) {
  judge(BlockScene(), kLevels);
  const std::string path = folder_.file("painted.svdag");
  // Where a raw colour of a chunk becomes the one after it, beyond a border of charts.
  std::string bytes = read_bytes(path);
  const Header& h = *reinterpret_cast<const Header*>(bytes.data());
  auto* const entries = reinterpret_cast<ColourEntry*>(bytes.data() + h.directory_offset);
  auto* const chunks = reinterpret_cast<uint32_t*>(bytes.data() + h.chunks_offset);
  size_t swapped = 0;
  for (uint64_t e = 0; e < h.directory_bytes / sizeof(ColourEntry); ++e) {
    if ((entries[e].value & kChunkEntry) == 0) continue;
    uint32_t* const words = chunks + (entries[e].value & ~kChunkEntry);
    const uint32_t runs = words[0], groups = chunk_groups(runs);
    uint64_t bit = 32 * uint64_t(1 + groups + chunk_header_words(runs));
    for (uint32_t r = 0; r < runs; ++r) {
      if (r % kGroupRuns == 0) bit += bit & 1;
      const uint32_t run =
          bits_at(words, 32 * uint64_t(1 + groups) + kRunHeaderBits * uint64_t(r), kRunHeaderBits);
      const uint32_t kind = run >> 8, length = run_length(run);
      for (uint32_t i = 0; kind == kRawRun && i + 1 < length && swapped < 40; ++i) {
        const uint64_t at = bit + uint64_t(kColourBits) * i;
        const uint32_t mine = bits_at(words, at, 24), next = bits_at(words, at + 24, 24);
        if (std::abs(int(mine & 255) - int(next & 255)) < 30) continue;
        for (uint32_t b = 0; b < 24; ++b) {
          const uint64_t w = at + b;
          words[w / 32] = (words[w / 32] & ~(1U << w % 32)) | (next >> b & 1U) << w % 32;
        }
        ++swapped;
      }
      bit += bits_per_run(kind) + uint64_t(bits_per_colour(kind)) * length;
    }
  }
  ASSERT_GT(swapped, 10u);
  repair_checksums(&bytes);
  write("painted.svdag", bytes);
  const ColourComparison c = compare(folder_.file("scene.glb"), path);
  EXPECT_GT(c.wrong, swapped / 2);
  EXPECT_LE(c.wrong, swapped);
  // Their coarser cubes have the mean of other colours.
  EXPECT_THAT(defects(), testing::Contains(testing::HasSubstr("coarser cube")));
}

TEST_F(ColourJudgement, AnotherSceneHasNoTriangles) {
  judge(BlockScene());
  PaintedGlb glb;
  std::vector<TestTriangle> triangles = chart_block();
  triangles.erase(triangles.begin());
  glb.add(glb.material({1, 1, 1}), triangles, false);
  const ColourComparison c =
      compare(write("other.glb", glb.bytes()), folder_.file("painted.svdag"));
  EXPECT_GT(c.without_triangle, 50u);
}

TEST_F(ColourJudgement, TheSameDrawIsMadeOfASeed) {
  draw_.count = 500;
  BlockScene painter;
  painter.factor = {0.5, 1, 1};
  const ColourComparison first = judge({}, painter);
  const ColourComparison again = compare(folder_.file("scene.glb"), folder_.file("painted.svdag"));
  draw_.seed = 2;
  const ColourComparison other = compare(folder_.file("scene.glb"), folder_.file("painted.svdag"));
  EXPECT_EQ(first.drawn, 500u);
  EXPECT_EQ(first.mean, again.mean);
  EXPECT_NE(first.mean, other.mean);
}

}  // namespace
}  // namespace svdag
#endif  // SVDAG_HAS_IMAGE_DECODERS
