// Edits of files with layers: each layer, and the union, against sets of bricks.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <random>

#include "builder/edit/edit.h"
#include "builder/edit/layer_pairs.h"
#include "io/dag/graph/select.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/reference_reduction.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"
#include "verify/integrity/integrity.h"

namespace svdag {
namespace {

using LayerBricks = std::map<std::string, BrickMap>;

BrickMap combined(SetOperation operation, const BrickMap& a, const BrickMap& b) {
  BrickMap result = a;
  if (operation == SetOperation::kUnion) {
    for (const auto& [at, brick] : b) result[at] |= brick;
    return result;
  }
  for (auto& [at, brick] : result) {
    const auto found = b.find(at);
    const uint64_t other = found == b.end() ? 0 : found->second;
    brick &= operation == SetOperation::kIntersection ? other : ~other;
  }
  std::erase_if(result, [](const auto& entry) { return entry.second == 0; });
  return result;
}

BrickMap all_of(const LayerBricks& layers) {
  BrickMap all;
  for (const auto& [name, bricks] : layers) all = combined(SetOperation::kUnion, all, bricks);
  return all;
}

// What a file holds.
struct Content {
  bool has_layers = false, has_union = true;
  BrickMap of_union;
  LayerBricks layers;
};

class EditLayers : public ::testing::Test {
 protected:
  TempFolder folder_;
  MemoryBudget budget_;
  WorkRoom room_{&budget_, folder_.path()};
  std::mt19937_64 random_;
  GridCube cube_{Point(-0.1), 1.2};

  uint64_t pick(uint64_t count) { return random_() % count; }

  std::string content_name(const char* file) { return folder_.file(std::string(file) + ".svdag"); }

  // Bakes some files of few names, as layers or not.
  BuildConfig random_scene(const char* name, Rule rule, LayerKind kind) {
    const std::string own = folder_.file(name);
    std::filesystem::create_directory(own);
    BuildConfig config;
    for (uint64_t i = 0, first = pick(3), count = 1 + pick(4); i < count; ++i) {
      config.scene.paths.push_back(own + "/part" + std::to_string(first + i) + ".stl");
      write_stl(config.scene.paths.back(),
                pick(3) ? random_soup(1 + pick(300), pick(2) ? 1 : 0.1, 1 + pick(4))
                        : bumpy_sphere(int(3 + pick(10))));
    }
    config.output = content_name(name);
    config.levels = 6;
    config.cube = cube_;
    config.rule = rule;
    config.layers = kind;
    config.with_union = kind == LayerKind::kNone || pick(4) != 0;
    if (pick(3) == 0) config.layout = Layout::kCompact;
    return config;
  }

  Content content(const std::string& path) {
    const DagFile file = DagFile::open(path);
    EXPECT_EQ(inspect_file(file, room_).defects, std::vector<std::string>());
    Content content{!file.layers().empty(), file.layers().has_union, {}, {}};
    if (content.has_union) content.of_union = bricks_of(file.view());
    for (size_t i = 0; i < file.layers().layers.size(); ++i)
      content.layers[file.layers().layers[i].name] = bricks_of(file.view_of(i));
    return content;
  }

  void edit_to(EditConfig config, const std::string& output) {
    config.output = output;
    ParallelExecutor executor(1 + pick(2));
    edit(config, &executor);
  }
};

// Set operations of files with layers, as docs/commands.md defines them.
Content expected(SetOperation operation, Content a, Content b) {
  Content result;
  const bool is_union = operation == SetOperation::kUnion;
  if (is_union && a.has_layers != b.has_layers) {
    Content* const plain = a.has_layers ? &b : &a;
    plain->has_layers = true;
    plain->layers = {{"", plain->of_union}};
  }
  const auto of_unions = [&] { return combined(operation, a.of_union, b.of_union); };
  result.has_layers = a.has_layers || (b.has_layers && operation == SetOperation::kIntersection);
  if (a.has_layers && b.has_layers) {
    result.has_union = a.has_union && (!is_union || b.has_union);
    result.layers = a.layers;
    if (is_union) result.layers.insert(b.layers.begin(), b.layers.end());
    for (auto& [name, bricks] : result.layers)
      bricks = combined(operation, a.layers[name], b.layers[name]);
    if (result.has_union) result.of_union = all_of(result.layers);
    return result;
  }
  if (result.has_layers && operation == SetOperation::kIntersection && !a.has_layers)
    std::swap(a, b);
  result.has_union = a.has_union;
  if (result.has_union) result.of_union = of_unions();
  for (const auto& [name, bricks] : a.layers)
    result.layers[name] = combined(operation, bricks, b.of_union);
  return result;
}

TEST_F(EditLayers, SetOperationsGoByLayerAndTheUnionIsTheirOr) {
  int layered = 0;
  for (uint64_t seed = 0; seed < 60 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    const Rule rule = pick(2) ? Rule::kConservative : Rule::kThin;
    for (const char* name : {"a", "b"})
      bake(random_scene(name, rule, pick(3) ? LayerKind::kFile : LayerKind::kNone));
    const Content a = content(content_name("a")), b = content(content_name("b"));
    for (const SetOperation operation :
         {SetOperation::kUnion, SetOperation::kIntersection, SetOperation::kDifference}) {
      SCOPED_TRACE(int(operation));
      EditConfig config;
      config.first = content_name("a");
      config.second = content_name("b");
      config.operation = operation;
      if (pick(3) == 0) config.selection.layout = Layout::kCompact;
      if (operation == SetOperation::kDifference && !a.has_layers && !b.has_union) {
        EXPECT_SVDAG_ERROR(edit_to(config, folder_.file("x.svdag")), ExitCode::kUsage,
                           "has no union of its layers to subtract");
        continue;
      }
      edit_to(config, folder_.file("result.svdag"));
      const Content result = content(folder_.file("result.svdag"));
      const Content wanted = expected(operation, a, b);
      EXPECT_EQ(result.has_layers, wanted.has_layers);
      EXPECT_EQ(result.has_union, wanted.has_union);
      EXPECT_EQ(result.layers, wanted.layers);
      EXPECT_EQ(result.of_union, wanted.of_union);
      if (result.has_layers && result.has_union) {
        EXPECT_EQ(result.of_union, all_of(result.layers));
      }
      layered += result.has_layers;
    }
  }
  EXPECT_GT(layered, 60);
}

TEST_F(EditLayers, ACropIsTheBakeWithBounds) {
  for (uint64_t seed = 0; seed < 40 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    const Rule rule = pick(2) ? Rule::kConservative : Rule::kThin;
    BuildConfig config = random_scene("a", rule, LayerKind::kFile);
    config.layout = Layout::kPlain;
    bake(config);
    EditConfig crop;
    crop.first = config.output;
    const auto unit = [&] { return double(pick(1000)) / 1000; };
    const Point corner(unit(), unit(), unit());
    crop.selection.bounds = Box{corner, corner + Point(0.01) + 0.5 * Point(unit(), unit(), unit())};
    edit_to(crop, folder_.file("crop.svdag"));
    config.bounds = crop.selection.bounds;
    config.output = folder_.file("baked.svdag");
    bake(config);
    EXPECT_EQ(nodes_of(DagFile::open(folder_.file("crop.svdag"))),
              nodes_of(DagFile::open(config.output)));
  }
}

TEST_F(EditLayers, ACoarserLevelAndOneLayerAreThoseOfEachLayer) {
  for (uint64_t seed = 0; seed < 30 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    random_.seed(seed);
    bake(random_scene("a", Rule::kConservative, LayerKind::kFile));
    const DagFile file = DagFile::open(content_name("a"));
    EditConfig config;
    config.first = content_name("a");
    config.selection.level = int(3 + pick(3));
    edit_to(config, folder_.file("coarse.svdag"));
    const DagFile coarse = DagFile::open(folder_.file("coarse.svdag"));
    EXPECT_EQ(inspect_file(coarse, room_).defects, std::vector<std::string>());
    EXPECT_EQ(coarse.layers().has_union, file.layers().has_union);
    ASSERT_EQ(coarse.layers().layers.size(), file.layers().layers.size());
    // The level of a layer alone, which needs no layers.
    for (size_t i = 0; i < file.layers().layers.size(); ++i) {
      const std::string& name = file.layers().layers[i].name;
      EXPECT_EQ(coarse.layers().layers[i].name, name);
      EXPECT_EQ(coarse.layers().layers[i].colour, file.layers().layers[i].colour);
      config.selection.layers = {name};
      edit_to(config, folder_.file("one.svdag"));
      const std::string one = nodes_of(DagFile::open(folder_.file("one.svdag")));
      EXPECT_EQ(nodes_of(derive(coarse, {.layers = {name}}, room_)), one);
      EditConfig level;
      level.selection.level = config.selection.level;
      level.first = folder_.file("alone.svdag");
      EditConfig alone;
      alone.first = config.first;
      alone.selection.layers = {name};
      edit_to(alone, level.first);
      EXPECT_EQ(nodes_of(derive(file, {.layers = {name}}, room_)),
                nodes_of(DagFile::open(level.first)));
      edit_to(level, folder_.file("two.svdag"));
      EXPECT_EQ(nodes_of(DagFile::open(folder_.file("two.svdag"))), one);
    }
  }
}

// Thousands of layers that overlap: the OR of their differences is made of sets of nodes.
TEST_F(EditLayers, ManyLayersHaveTheUnionOfTheirDifferences) {
  for (const char* name : {"a", "b"}) {
    std::string obj;
    random_.seed(name[0] == 'a' ? 1 : 2);
    for (int i = 0; i < 3000; ++i) {
      obj += "o part" + std::to_string(i) + "\n";
      for (int v = 0; v < 3; ++v) {
        obj += "v";
        for (int axis = 0; axis < 3; ++axis) obj += " " + std::to_string(pick(100));
        obj += "\n";
      }
      obj += "f -3 -2 -1\n";
    }
    BuildConfig config =
        config_for(folder_.write(std::string(name) + ".obj", obj), content_name(name), 5);
    config.cube = GridCube{Point(-1), 102};
    config.layers = LayerKind::kObject;
    bake(config);
  }
  EditConfig config;
  config.first = content_name("a");
  config.second = content_name("b");
  config.operation = SetOperation::kDifference;
  edit_to(config, folder_.file("result.svdag"));
  const Content result = content(folder_.file("result.svdag"));
  EXPECT_EQ(result.layers.size(), 3000U);
  EXPECT_EQ(result.of_union, all_of(result.layers));
}

// Two equal boxes cancel out inside, by the rule of odd windings.
TEST_F(EditLayers, OfASolidAUnionThatIsEmptyBesideALayerIsLeftOut) {
  BuildConfig config = random_scene("a", Rule::kSolidOdd, LayerKind::kFile);
  config.scene.paths = {folder_.file("one.stl"), folder_.file("two.stl")};
  for (const std::string& path : config.scene.paths)
    write_stl(path, closed_box(Point(0), Point(1)));
  config.with_union = true;
  bake(config);
  const Content whole = content(config.output);
  EXPECT_LT(whole.of_union.size(), whole.layers.at("one.stl").size());
  EditConfig crop;
  crop.first = config.output;
  crop.selection.bounds = Box{Point(0.3), Point(0.6)};
  edit_to(crop, folder_.file("inside.svdag"));
  const Content inside = content(folder_.file("inside.svdag"));
  EXPECT_FALSE(inside.has_union);
  EXPECT_FALSE(inside.layers.at("one.stl").empty());
  EXPECT_EQ(inside.layers.at("one.stl"), inside.layers.at("two.stl"));
  crop.selection.bounds = Box{Point(-0.05), Point(0.6)};  // with a part of the surface
  edit_to(crop, folder_.file("corner.svdag"));
  EXPECT_TRUE(content(folder_.file("corner.svdag")).has_union);
  // The union of the layerwise difference is their OR.
  EditConfig difference;
  difference.first = config.output;
  difference.second = folder_.file("corner.svdag");
  difference.operation = SetOperation::kDifference;
  edit_to(difference, folder_.file("rest.svdag"));
  const Content rest = content(folder_.file("rest.svdag"));
  EXPECT_EQ(rest.of_union, all_of(rest.layers));
}

TEST(LayerPairs, UnionsHaveAtMost65535Layers) {
  LayerSets a{"a.svdag", {LayerKind::kObject, false, 0, {}}, {}}, b = a;
  for (uint32_t i = 0; i < kMaxLayers; ++i) {
    (i % 2 ? a : b).layers.layers.push_back({std::to_string(i), {}});
    (i % 2 ? a : b).roots.push_back(i);
  }
  EXPECT_EQ(match_layers(SetOperation::kUnion, a, b).roots.size(), size_t(kMaxLayers));
  a.layers.layers.push_back({"one more", {}});
  a.roots.push_back(0);
  EXPECT_SVDAG_ERROR(match_layers(SetOperation::kUnion, a, b), ExitCode::kUsage,
                     "more than 65535 layers together");
  EXPECT_EQ(match_layers(SetOperation::kDifference, a, b).roots.size(), a.roots.size());
}

TEST_F(EditLayers, OfAUnionHaveTheSmallerColour) {
  for (const char* name : {"a", "b"}) {
    const bool is_a = name[0] == 'a';
    folder_.write(std::string(name) + ".mtl",
                  std::string("newmtl both\nKd ") + (is_a ? "1 0 0" : "0 0 1") + "\n");
    BuildConfig config =
        config_for(folder_.write(std::string(name) + ".obj",
                                 "mtllib " + std::string(name) +
                                     ".mtl\nusemtl both\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                   content_name(name), 4);
    config.cube = GridCube{Point(-1), 3};
    config.layers = LayerKind::kMaterial;
    config.scene.colours = true;
    bake(config);
  }
  EditConfig config;
  for (const auto& [first, second] : {std::pair("a", "b"), std::pair("b", "a")}) {
    config.first = content_name(first);
    config.second = content_name(second);
    config.operation = SetOperation::kUnion;
    edit_to(config, folder_.file("result.svdag"));
    const DagFile result = DagFile::open(folder_.file("result.svdag"));
    ASSERT_EQ(result.layers().layers.size(), 1U);
    EXPECT_EQ(result.layers().layers[0].colour, (Colour{0, 0, 255}));
    config.operation = SetOperation::kIntersection;
    edit_to(config, folder_.file("result.svdag"));
    EXPECT_EQ(DagFile::open(folder_.file("result.svdag")).layers().layers[0].colour,
              first[0] == 'a' ? (Colour{255, 0, 0}) : (Colour{0, 0, 255}));
  }
}

}  // namespace
}  // namespace svdag
