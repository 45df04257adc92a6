// A scene that changes while it is baked is rejected: never is a bake of two scenes, and
// never a journal with the hash of another.
#include "streaming/file/input_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <thread>

#include "builder/cache/cell_store.h"
#include "builder/reduce/run.h"
#include "tests/builder/bakes.h"
#include "tests/expect_error.h"
#include "tests/soup.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using Action = std::function<void()>;

// An empty store that acts at the first look-up: the triangles have been
// read then, and nothing was saved.
class ActingStore final : public CellStore {
 public:
  explicit ActingStore(Action action) : action_(std::move(action)) {}

  CellKey key(const Cube&, const TriangleList&, int32_t) const override {
    std::call_once(once_, action_);
    return {};
  }
  bool take(const CellKey&, const Cube&, SubDagSets) override { return false; }
  void load_taken(const std::function<std::optional<SpillTarget>(uint64_t)>&,
                  const std::function<void(BakedRun)>&) override {}
  void keep(const BakedRun&, SpillFile*) override {}
  CellStoreCounts counts() const override { return {}; }

 private:
  Action action_;
  mutable std::once_flag once_;
};

class ChangedScene : public ::testing::Test {
 protected:
  ChangedScene() { write_stl(scene_, random_soup(20'000, 0.1, 1)); }

  // Acts between the pass for the box and the pass for the triangles.
  void between_passes(Action action) {
    config_.open_store = [action = std::move(action)](const Grid&, Rule, MemoryBudget*) {
      action();
      return std::unique_ptr<CellStore>();
    };
  }
  // Acts when the triangles have been read.
  void after_triangles(Action action) {
    config_.open_store = [action = std::move(action)](const Grid&, Rule, MemoryBudget*) {
      return std::make_unique<ActingStore>(action);
    };
  }
  void rewrite() { write_stl(scene_, random_soup(20'001, 0.1, 2)); }
  void expect_refused(const std::string& file) {
    EXPECT_SVDAG_ERROR(bake(config_), ExitCode::kBadInput,
                       file + ": was changed while it was read");
    EXPECT_FALSE(std::filesystem::exists(config_.output));
    EXPECT_FALSE(std::filesystem::exists(config_.output + ".scratch"));
  }

  TempFolder folder_;
  std::string scene_ = folder_.file("scene.stl");
  BuildConfig config_ = config_for(scene_, folder_.file("out.svdag"), 8);
};

TEST_F(ChangedScene, IsRefusedBetweenThePasses) {
  between_passes([this] { rewrite(); });
  expect_refused("scene.stl");
}

TEST_F(ChangedScene, IsRefusedBetweenThePassesWhereMemoryIsShort) {
  config_.memory = uint64_t(4) << 20;  // triangles are spilled and saved
  between_passes([this] { rewrite(); });
  expect_refused("scene.stl");
}

// Nothing reads it again, and a report names what was read.
TEST_F(ChangedScene, MattersNoMoreWhenItsTrianglesWereRead) {
  for (const bool hash_files : {false, true}) {
    config_.hash_files = hash_files;
    config_.open_store = {};
    write_stl(scene_, random_soup(20'000, 0.1, 1));
    const std::vector<SceneFile> named = bake(config_).files;
    const std::string expected = read_bytes(config_.output);
    after_triangles([this] { rewrite(); });
    const BuildReport report = bake(config_);
    EXPECT_EQ(read_bytes(config_.output), expected);
    ASSERT_EQ(report.files.size(), hash_files ? 1U : 0U);
    for (const SceneFile& file : report.files) EXPECT_EQ(file.hash, named[0].hash);
  }
}

// Then no journal is written, since it would have to describe the scene.
TEST_F(ChangedScene, MattersNoMoreWhereWorkIsSavedLater) {
  config_.checkpoint = 1e-6;
  config_.memory = uint64_t(40) << 20;
  bake(config_);
  const std::string expected = read_bytes(config_.output);
  for (const bool removed : {false, true}) {
    write_stl(scene_, random_soup(20'000, 0.1, 1));
    after_triangles([&] { removed ? void(std::filesystem::remove(scene_)) : rewrite(); });
    EXPECT_GT(bake(config_).runs, 1U);
    EXPECT_EQ(read_bytes(config_.output), expected);
    EXPECT_FALSE(std::filesystem::exists(config_.output + ".scratch"));
  }
}

TEST_F(ChangedScene, IsKnownByItsInodeWhereAnotherFileTookItsName) {
  std::filesystem::copy_file(scene_, folder_.file("copy"));
  between_passes([this] { std::filesystem::rename(folder_.file("copy"), scene_); });
  expect_refused("scene.stl");
}

TEST_F(ChangedScene, IsKnownByTheTimeOfItsWritingWhereItsSizeIsAsBefore) {
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // a tick of the kernel's clock
  between_passes([this] { write_stl(scene_, random_soup(20'000, 0.1, 2)); });
  expect_refused("scene.stl");
}

// As backups do: the time of the last change of the inode is another, the content is not.
TEST_F(ChangedScene, IsNotOneThatGotAnotherNameOrOtherPermissions) {
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  between_passes([this] {
    std::filesystem::create_hard_link(scene_, folder_.file("link"));
    std::filesystem::permissions(scene_, std::filesystem::perms::owner_read);
  });
  bake(config_);
}

TEST_F(ChangedScene, IsNotOneThatSomebodyRead) {
  between_passes([this] { read_bytes(scene_); });
  bake(config_);
}

TEST_F(ChangedScene, IsOneOfWhichABufferHasChanged) {
  std::ofstream(folder_.file("a.gltf")) << R"({"asset": {"version": "2.0"},
      "buffers": [{"uri": "a.bin", "byteLength": 36}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})";
  const auto write_buffer = [this](float size, size_t bytes) {
    const float corners[9] = {0, 0, 0, size, 0, 0, 0, size, 0};
    std::string buffer(bytes, ' ');
    std::memcpy(buffer.data(), corners, sizeof corners);
    std::ofstream(folder_.file("a.bin"), std::ios::binary) << buffer;
  };
  write_buffer(1, 36);
  config_.scene.paths = {scene_, folder_.file("a.gltf")};
  bake(config_);
  std::filesystem::remove(config_.output);
  between_passes([&] { write_buffer(2, 40); });
  expect_refused("a.bin");
}

TEST_F(ChangedScene, IsNoneWhereItIsLeftOut) {
  const std::string other = folder_.file("other.stl");
  write_stl(other, random_soup(10, 0.1, 3));
  config_.scene.paths = {scene_, other};
  config_.scene.names.exclude = {"other.stl"};
  between_passes([&] { std::filesystem::remove(other); });
  bake(config_);
}

}  // namespace
}  // namespace svdag
