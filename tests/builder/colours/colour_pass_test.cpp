// The pass over a scene's colours beside a plain reference, which tests each triangle in each
// covered cube: any threads, memory and order of triangles give its colours.
#include "builder/colours/colour_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>

#include "builder/colours/cube_share.h"
#include "builder/octree/morton.h"
#include "io/lattice.h"
#include "tests/builder/bakes.h"
#include "tests/builder/colours/painted_scene.h"
#include "verify/judge/judge.h"

namespace svdag {
namespace {

class ColourPass : public testing::Test {
 protected:
  // Of a cube of the colour level.
  struct Stored {
    bool has_colour, is_constant;
    std::array<uint16_t, 3> linear;
    bool operator==(const Stored&) const = default;
  };
  using Colours = std::map<uint64_t, Stored>;  // by Morton code

  static SceneConfig scene_config(const std::string& path) {
    SceneConfig config;
    config.paths = {path};
    config.colours = config.paint = true;
    return config;
  }

  DagFile bake_scene(const std::string& path, int levels, Rule rule = Rule::kConservative,
                     LayerKind layers = LayerKind::kNone) {
    BuildConfig config =
        config_for(path, folder_.path() + "/" + std::to_string(++files_) + ".svdag", levels);
    config.rule = rule;
    config.layers = layers;
    config.open_as_sheets = true;
    bake(config);
    return DagFile::open(config.output);
  }

  // The covered cubes of `level`, ascending.
  static std::vector<LatticePoint> covered(const DagFile& file, int level) {
    std::map<uint64_t, LatticePoint> cubes;
    const int64_t n = int64_t(1) << file.view().levels;
    const int shift = int(file.view().levels) - level;
    for (int64_t x = 0; x < n; ++x) {
      for (int64_t y = 0; y < n; ++y) {
        for (int64_t z = 0; z < n; ++z) {
          const LatticePoint cube = {x >> shift, y >> shift, z >> shift};
          if (dag_voxel(file.view(), uint32_t(x), uint32_t(y), uint32_t(z)))
            cubes[morton(cube)] = cube;
        }
      }
    }
    std::vector<LatticePoint> list;
    for (const auto& [code, cube] : cubes) list.push_back(cube);
    return list;
  }

  Colours pass(const DagFile& file, const std::string& path, int level, size_t threads = 1,
               uint64_t memory = 256 * kMiB, uint64_t begin = 0) {
    Workspace workspace(folder_.path() + "/scratch", memory, threads);
    workspace.folder()->clear();
    const SpillSpace vertices = workspace.vertices();
    const Scene scene(scene_config(path), workspace.budget(), &vertices);
    ParallelExecutor executor(threads);
    Progress progress;
    const std::vector<LatticePoint> cubes = covered(file, level);
    Colours colours;
    const int below = 3 * (int(file.view().levels) - level);
    size_t next = 0;
    const auto move_to = [&](uint64_t code) {
      while (next < cubes.size() && morton(cubes[next]) << below < code) ++next;
      return next;
    };
    move_to(begin);
    ends_.clear();
    report_ = colour_cubes(
        file, scene, {level}, &workspace, &executor, &progress,
        [&](std::span<const CubeColour> entries) {
          for (const CubeColour& e : entries) {
            const int up = 3 * (level - e.level);
            const size_t first = next;
            while (next < cubes.size() && morton(cubes[next]) >> up == e.morton)
              colours[morton(cubes[next++])] = {
                  e.has_colour, e.is_constant, {e.linear[0], e.linear[1], e.linear[2]}};
            EXPECT_GT(next, first) << "an entry out of order, or of no cube";
          }
        },
        begin,
        [&](uint64_t end) {
          const size_t passed = next;
          EXPECT_EQ(move_to(end), passed) << "a cube before the end has no colour yet";
          EXPECT_TRUE(next == cubes.size() || morton(cubes[next]) << below >= end);
          ends_.push_back(end);
        });
    EXPECT_EQ(next, cubes.size());
    return colours;
  }

  // Each triangle in each cube.
  static Colours reference(const DagFile& file, const std::string& path, int level) {
    MemoryBudget budget;
    const Scene scene(scene_config(path), &budget);
    const Lattice lattice(file.grid());
    std::vector<std::unique_ptr<Paints>> paints;
    std::vector<std::pair<PaintedTriangle, const Paints*>> triangles;
    scene.stream([&](const TriangleBatch& batch) {
      if (batch.cut != nullptr && batch.cut->is_transparent()) return;
      paints.push_back(std::make_unique<Paints>());
      if (batch.paint != nullptr) paints.back()->push_back(*batch.paint);
      for (size_t k = 0; k < batch.triangles.size(); ++k) {
        PaintedTriangle t;
        for (size_t i = 0; i < 3; ++i) {
          t.corners[i].position = lattice.snap(batch.triangles[k].v[i]);
          if (batch.paint == nullptr) {
            const Colour c = batch.colour.value_or(Colour{255, 255, 255});
            t.corners[i].colour = {light16_of_code(c.r), light16_of_code(c.g),
                                   light16_of_code(c.b)};
            continue;
          }
          t.paint = 0;
          t.corners[i].texture = batch.texture[k][i];
          t.corners[i].colour = batch.corner_colours[k][i];
        }
        const auto& c = t.corners;
        if (t.paint == 0 && !batch.paint->image && c[0].colour == c[1].colour &&
            c[0].colour == c[2].colour) {
          t.paint = kOneColour;
          for (size_t a = 0; a < 3; ++a) {
            const double light = batch.paint->factor[a] * c[0].colour[a] / 65535.0;
            for (auto& corner : t.corners) corner.colour[a] = uint16_t(light * 65535 + 0.5);
          }
        }
        sort_corners(&t);
        triangles.push_back({t, paints.back().get()});
      }
    });
    const auto judge = make_judge({});
    Colours colours;
    for (const LatticePoint& cube : covered(file, level)) {
      const int side = Cube{level, cube}.side_log2(file.grid().levels);
      const LatticePoint corner = Cube{level, cube}.corner(file.grid().levels);
      unsigned __int128 sum[3][4] = {};  // by area, by opacity, of all
      Stored stored{false, true, {}};
      for (const auto& [t, paint] : triangles) {
        if (!judge->touches(t.triangle(), side, cube)) continue;
        const TriangleSetup setup = make_setup(t.triangle());
        const ShareSetup shares(t, setup, *paint, side);
        const CubeShare share = shares.share_in(corner), nearest = shares.nearest_to_centre(corner);
        const std::array<uint16_t, 3> one = t.corners[0].colour;
        if (!stored.has_colour) stored.linear = one;
        stored.is_constant &= t.paint == kOneColour && one == stored.linear;
        stored.has_colour = true;
        for (size_t a = 0; a < 4; ++a) {
          sum[0][a] += (unsigned __int128)(share.area) * (a == 3 ? 1 : share.colour[a]);
          sum[1][a] += (unsigned __int128)(nearest.area) * (a == 3 ? 1 : nearest.colour[a]);
          sum[2][a] += a == 3 ? 1 : nearest.colour[a];
        }
      }
      if (stored.has_colour && !stored.is_constant) {
        const auto& s = sum[0][3] != 0 ? sum[0] : sum[1][3] != 0 ? sum[1] : sum[2];
        for (size_t a = 0; a < 3; ++a) stored.linear[a] = uint16_t((s[a] + s[3] / 2) / s[3]);
      }
      if (!stored.has_colour) stored.is_constant = false;
      colours[morton(cube)] = stored;
    }
    return colours;
  }

  std::string write(const std::string& name, const std::string& bytes) {
    return folder_.write(name, bytes);
  }

  TempFolder folder_;
  int files_ = 0;
  ColourPassReport report_;
  std::vector<uint64_t> ends_;  // that pass() could be continued from
};

std::vector<TestTriangle> box(const Point& low, const Point& high) {
  std::vector<TestTriangle> triangles;
  for (int a = 0; a < 3; ++a) {
    for (int side = 0; side < 2; ++side) {
      Point p[4];
      for (int k = 0; k < 4; ++k) {
        p[k][a] = side == 0 ? low[a] : high[a];
        const int u = k == 1 || k == 2, v = k >= 2;
        p[k][(a + 1) % 3] = u == 0 ? low[(a + 1) % 3] : high[(a + 1) % 3];
        p[k][(a + 2) % 3] = v == 0 ? low[(a + 2) % 3] : high[(a + 2) % 3];
      }
      for (int half = 0; half < 2; ++half) {
        TestTriangle t;
        t.triangle = {{p[0], p[1 + half], p[2 + half]}};
        if (side == 0) std::swap(t.triangle.v[1], t.triangle.v[2]);
        t.texture = {{{0, 0}, {1, 0}, {1, 1}}};
        triangles.push_back(t);
      }
    }
  }
  return triangles;
}

struct SceneOptions {
  bool is_masked = false;  // textures are cut out
  bool has_box = false;    // a closed one in the middle
};

// Textured charts that meet at seams, duplicates, slivers, segments, colours of corners, and
// triangles of one colour; `order` shuffles the triangles and their corners.
std::string random_scene(uint64_t seed, size_t count, SceneOptions options = {},
                         uint64_t order = 0) {
  std::mt19937_64 random(seed), shuffling(order);
  const auto unit = [&] { return float(random() >> 40) * 0x1p-24F; };
  PaintedGlb glb;
  std::string rgba;
  const uint32_t width = 1 + uint32_t(random() % 20), height = 1 + uint32_t(random() % 20);
  for (uint32_t i = 0; i < 4 * width * height; ++i)
    rgba += char(i % 4 == 3 && !options.is_masked ? 255 : random() & 255);
  const int wraps[] = {33071, 33648, 10497};
  const int texture = glb.texture(width, height, rgba,
                                  {{"wrapS", wraps[random() % 3]},
                                   {"wrapT", wraps[random() % 3]},
                                   {"magFilter", random() % 2 == 0 ? 9728 : 9729}});
  for (int kind = 0; kind < 5; ++kind) {
    std::vector<TestTriangle> triangles;
    for (size_t k = 0; k < count; ++k) {
      TestTriangle t;
      const Point centre(unit(), unit(), unit());
      const double size = k % 7 == 0 ? 0.8 : 0.15;
      for (size_t i = 0; i < 3; ++i) {
        t.triangle.v[i] = centre + size * Point(unit() - 0.5, unit() - 0.5, unit() - 0.5);
        t.texture[i] = {3 * unit() - 1, 3 * unit() - 1};
        for (float& c : t.colour[i]) c = kind == 3 ? 0.5F : unit();
      }
      if (k % 5 == 1) t.triangle.v[2] = t.triangle.v[0] + 1e-5 * Point(unit(), unit(), unit());
      if (k % 11 == 2) t.triangle.v[2] = t.triangle.v[1];
      if (k % 6 == 3) {  // an axis-parallel wall
        for (Point& p : t.triangle.v) p[int(k) % 3] = double(int(8 * centre.x)) / 8;
      }
      if (k % 9 == 4 && !triangles.empty()) t = triangles.back();  // a duplicate
      if (k % 9 == 5 && !triangles.empty()) {                      // a neighbour, of another chart
        t.triangle.v[0] = triangles.back().triangle.v[0];
        t.triangle.v[1] = triangles.back().triangle.v[1];
      }
      triangles.push_back(t);
    }
    if (order != 0) {
      std::ranges::shuffle(triangles, shuffling);
      for (TestTriangle& t : triangles) {
        const size_t first = shuffling() % 3, second = (first + 1 + shuffling() % 2) % 3;
        std::swap(t.triangle.v[first], t.triangle.v[second]);
        std::swap(t.texture[first], t.texture[second]);
        std::swap(t.colour[first], t.colour[second]);
      }
    }
    const bool has_texture = kind == 0 || kind == 1, has_colours = kind >= 1 && kind < 4;
    nlohmann::json material = glb.material({0.25 * kind, 0.8, 0.3}, has_texture ? texture : -1);
    if (options.is_masked && has_texture) material["alphaMode"] = "MASK";
    glb.add(material, triangles, has_colours);
  }
  if (options.has_box)
    glb.add(glb.material({1, 0.5, 0}, texture), box(Point(0.25), Point(0.75)), false);
  return glb.bytes();
}

// SVDAG_LONG=1: 2,000 scenes.
TEST_F(ColourPass, IsTheReferenceWhateverTheThreadsMemoryOrderAndBeginning) {
  const uint64_t scenes = std::getenv("SVDAG_LONG") != nullptr ? 2000 : 20;
  constexpr Rule kRules[] = {Rule::kConservative, Rule::kThin, Rule::kSolid};
  constexpr LayerKind kLayers[] = {LayerKind::kNone, LayerKind::kMaterial, LayerKind::kObject};
  for (uint64_t seed = 1; seed <= scenes; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const int levels = 4 + int(random() % 2), level = 3 + int(random() % size_t(levels - 2));
    const Rule rule = kRules[random() % 3];
    const LayerKind layers = kLayers[random() % 3];
    const SceneOptions options = {.is_masked = rule != Rule::kSolid && random() % 3 == 0,
                                  .has_box = rule == Rule::kSolid || random() % 4 == 0};
    const std::string path = write("scene.glb", random_scene(seed, 12, options));
    const std::string shuffled = write("shuffled.glb", random_scene(seed, 12, options, seed));
    const DagFile file = bake_scene(path, levels, rule, layers);
    const Colours expected = reference(file, path, level);
    EXPECT_EQ(pass(file, path, level), expected);
    EXPECT_EQ(pass(file, path, level, 3, 6 * kMiB), expected);
    EXPECT_EQ(pass(file, shuffled, level, 2), expected);
    if (ends_.empty()) continue;
    const uint64_t begin = ends_[random() % ends_.size()];
    Colours rest = expected;
    const int below = 3 * (levels - level);
    std::erase_if(rest, [&](const auto& colour) { return colour.first << below < begin; });
    EXPECT_EQ(pass(file, path, level, 1, 256 * kMiB, begin), rest);
  }
}

TEST_F(ColourPass, IsTheSameFromBins) {
  const std::string path = write("scene.glb", random_scene(7, 1500));
  const DagFile file = bake_scene(path, 6);
  for (const int level : {3, 5, 6}) {
    const Colours expected = pass(file, path, level);
    EXPECT_EQ(pass(file, path, level, 1, 8 * kMiB), expected) << level;
    EXPECT_EQ(pass(file, path, level, 2, 6 * kMiB), expected) << level;
  }
}

// Whatever memory, threads and bins the two passes have.
TEST_F(ColourPass, BeginsWhereAnotherOneWas) {
  for (const Rule rule : {Rule::kConservative, Rule::kSolid}) {
    PaintedGlb glb;
    const int texture = glb.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
    glb.add(glb.material({1, 0.5, 0}, texture), box(Point(0), Point(1)), false);
    const std::string path =
        write("scene.glb", rule == Rule::kSolid ? glb.bytes() : random_scene(7, 1500));
    const DagFile file = bake_scene(path, 7, rule);
    const Colours expected = pass(file, path, 7);
    for (const uint64_t before : {256 * kMiB, 6 * kMiB}) {
      pass(file, path, 7, 2, before);
      const std::vector<uint64_t> ends = ends_;
      ASSERT_GE(ends.size(), 2U);
      for (size_t i = 0; i < ends.size(); i += 1 + ends.size() / 5) {
        Colours rest = expected;
        std::erase_if(rest, [&](const auto& colour) { return colour.first < ends[i]; });
        EXPECT_EQ(pass(file, path, 7, 1, 256 * kMiB, ends[i]), rest);
        EXPECT_EQ(pass(file, path, 7, 2, 6 * kMiB, ends[i]), rest);
      }
    }
  }
}

// More triangles in one cube than fit in memory.
TEST_F(ColourPass, ACubeMayHaveAnyNumberOfTriangles) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return float(random() >> 40) * 0x1p-24F; };
  PaintedGlb glb;
  const int texture = glb.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
  std::vector<TestTriangle> triangles(6000);
  for (TestTriangle& t : triangles) {
    for (size_t i = 0; i < 3; ++i) {
      t.triangle.v[i] = 1e-3 * Point(unit(), unit(), unit());
      t.texture[i] = {unit(), unit()};
    }
  }
  triangles[0].triangle.v[0] = Point(1);
  glb.add(glb.material({1, 1, 1}, texture), triangles, false);
  const std::string path = write("scene.glb", glb.bytes());
  const DagFile file = bake_scene(path, 4);
  EXPECT_EQ(pass(file, path, 4, 2, 4 * kMiB), pass(file, path, 4));
}

TEST_F(ColourPass, TheInsideOfASolidHasNoColour) {
  for (const bool has_texture : {false, true}) {
    PaintedGlb glb;
    const int texture = glb.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
    glb.add(glb.material({1, 0.5, 0}, has_texture ? texture : -1), box(Point(0), Point(1)), false);
    const std::string path = write("scene.glb", glb.bytes());
    const DagFile file = bake_scene(path, 5, Rule::kSolid);
    for (const int level : {3, 5}) {
      const Colours colours = pass(file, path, level);
      EXPECT_EQ(colours, reference(file, path, level));
      EXPECT_EQ(std::ranges::count_if(colours, [](const auto& c) { return !c.second.has_colour; }),
                level == 3 ? 6 * 6 * 6 : 30 * 30 * 30);
    }
  }
}

TEST_F(ColourPass, AWallThinnerThanACubeHasTheMeanOfItsSides) {
  PaintedGlb glb;
  for (const double z : {0.0, 0.001}) {
    std::vector<TestTriangle> wall = box(Point(0, 0, z), Point(1, 1, z));
    glb.add(glb.material({z == 0 ? 1.0 : 0.0, 0.25, z == 0 ? 0.0 : 1.0}), wall, false);
  }
  const std::string path = write("scene.glb", glb.bytes());
  const DagFile file = bake_scene(path, 4);
  int tested = 0;
  for (const auto& [code, stored] : pass(file, path, 4)) {
    EXPECT_FALSE(stored.is_constant);
    const LatticePoint cube = unmorton(code);
    if (cube.x == 0 || cube.x == 15 || cube.y == 0 || cube.y == 15) continue;
    EXPECT_NEAR(stored.linear[0], kWhite16 / 2, 1);
    EXPECT_NEAR(stored.linear[1], kWhite16 / 4, 150);  // its code of sRGB
    EXPECT_NEAR(stored.linear[2], kWhite16 / 2, 1);
    ++tested;
  }
  EXPECT_EQ(tested, 14 * 14);
}

TEST_F(ColourPass, OneColourNeedsNoPairs) {
  PaintedGlb glb;
  glb.add(glb.material({1, 1, 1}), box(Point(0), Point(1)), false);
  const std::string path = write("scene.glb", glb.bytes());
  const DagFile file = bake_scene(path, 6);
  EXPECT_EQ(pass(file, path, 6).begin()->second,
            (Stored{true, true, {kWhite16, kWhite16, kWhite16}}));
  EXPECT_LE(report_.entries, 8u);
  EXPECT_EQ(report_.pairs, 0u);
}

TEST_F(ColourPass, AForeignSceneIsRefusedWithTheNumberOfCubes) {
  PaintedGlb glb, other, smaller;
  const int texture = glb.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
  other.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
  smaller.texture(2, 1, std::string("\xff\0\0\xff\0\xff\xff\xff", 8));
  std::vector<TestTriangle> triangles = box(Point(0), Point(1));
  glb.add(glb.material({1, 1, 1}, texture), triangles, false);
  triangles.pop_back();
  other.add(other.material({1, 1, 1}, texture), triangles, false);
  smaller.add(smaller.material({1, 1, 1}, texture), box(Point(0), Point(1, 1, 0.5)), false);
  const std::string path = write("scene.glb", glb.bytes());
  const DagFile file = bake_scene(path, 4);
  const auto failure = [&](const std::string& bytes) -> std::string {
    const std::string foreign = write("other.glb", bytes);
    Workspace workspace(folder_.path() + "/scratch", 64 * kMiB, 1);
    const Scene scene(scene_config(foreign), workspace.budget());
    SequentialExecutor executor;
    Progress progress;
    try {
      colour_cubes(file, scene, {4}, &workspace, &executor, &progress, [](const auto&) {});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(failure(glb.bytes()), "");
  EXPECT_NE(failure(other.bytes()).find("78 of its cubes have no triangle"), std::string::npos)
      << failure(other.bytes());
  EXPECT_NE(failure(smaller.bytes())
                .find("on axis z its voxels reach from 0 to 15, the scene from 0 to 8"),
            std::string::npos)
      << failure(smaller.bytes());
}

}  // namespace
}  // namespace svdag
