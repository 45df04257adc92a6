// glTF files that are broken or mean harm: one clear Error, never a crash or a huge allocation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

using nlohmann::json;
using testing::HasSubstr;


GltfBuilder indexed_triangle() {
  GltfBuilder gltf;
  const int positions = gltf.accessor(kTriangle, "VEC3");
  gltf.show(gltf.mesh(positions, gltf.accessor(std::vector<uint16_t>{0, 1, 2}, "SCALAR")));
  return gltf;
}

// scenes/scene.gltf refers to `uri`; secret.bin is outside of scenes.
class GltfUri : public testing::Test {
 protected:
  GltfUri() { std::filesystem::create_directories(folder_.path() + "/scenes/sub dir"); }

  std::string scene(const std::string& uri) const {
    return folder_.write("scenes/scene.gltf", gltf_.text(uri));
  }
  void place(const std::string& name) const { folder_.write(name, gltf_.bytes); }

  TempFolder folder_;
  GltfBuilder gltf_ = indexed_triangle();
};

TEST_F(GltfUri, FilesInTheFolderOfTheSceneAreRead) {
  for (const char* name : {"a.bin", "A..B.bin", "..b.bin", "sub dir/c.bin", "ä.bin", "100%.bin"}) {
    place("scenes/" + std::string(name));
  }
  for (const char* uri : {"a.bin", "./a.bin", "A..B.bin", "..b.bin", "sub%20dir/c.bin",
                          "sub dir/c.bin", "%C3%A4.bin", "%61.bin", "100%25.bin"}) {
    EXPECT_EQ(read_corners(scene(uri)).size(), 3u) << uri;
  }
}

TEST_F(GltfUri, NothingOutsideOfTheFolderIsOpened) {
  place("secret.bin");
  place("scenes/a.bin");
  const std::string absolute = folder_.path() + "/secret.bin";
  std::filesystem::create_symlink(absolute, folder_.path() + "/scenes/link.bin");
  std::filesystem::create_directory_symlink(folder_.path(), folder_.path() + "/scenes/up");
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("%2E%2E%2Fsecret.bin"), std::string("sub%20dir/../../secret.bin"),
        std::string("../scenes/a.bin"), std::string("../../etc/passwd"), std::string("/etc/passwd"),
        absolute, "file://" + absolute, std::string("file:a.bin"),
        std::string("http://localhost/a.bin"), std::string("C:\\a.bin"), std::string("link.bin"),
        std::string("up/secret.bin"), std::string("a.bin%00.png")}) {
    EXPECT_THAT(failure(scene(uri)), HasSubstr("folder")) << uri;
  }
}

// The file outside holds the requested triangle: an escape would be detected.
TEST_F(GltfUri, NoSpellingOfAWayOutIsOne) {
  namespace fs = std::filesystem;
  const std::string top = folder_.path(), inside = top + "/scenes/";
  place("secret.bin");
  place("scenes/a.bin");
  fs::create_symlink("../secret.bin", inside + "relative.bin");
  fs::create_symlink("relative.bin", inside + "twice.bin");
  fs::create_symlink("/dev/zero", inside + "zero.bin");
  fs::create_symlink("loop.bin", inside + "loop.bin");
  fs::create_directory_symlink("..", inside + "parent");
  fs::create_directory_symlink("/", inside + "sub dir/root");
  const std::string ways[] = {
      "..",
      ".",
      "",
      "..%2fsecret.bin",
      "%2e./secret.bin",
      ".%2E/secret.bin",
      "./../secret.bin",
      ".//..//secret.bin",
      "sub%20dir/%2e%2e/%2e%2e/secret.bin",
      "sub%20dir/..%2F..%2Fsecret.bin",
      "%252e%252e/secret.bin",
      "%c0%ae%c0%ae/secret.bin",
      "..\\secret.bin",
      "..%5csecret.bin",
      "\\\\host\\share\\secret.bin",
      "C:/secret.bin",
      "c:secret.bin",
      "//localhost/etc/passwd",
      "%2fetc%2fpasswd",
      "/dev/zero",
      "/proc/self/environ",
      "FILE:///etc/passwd",
      "file://localhost" + top + "/secret.bin",
      "https://localhost/secret.bin",
      "%00",
      "%00../secret.bin",
      "../secret.bin%00a.bin",
      "?../secret.bin",
      "#../secret.bin",
      "~/secret.bin",
      "$HOME/secret.bin",
      "relative.bin",
      "twice.bin",
      "zero.bin",
      "loop.bin",
      "parent/secret.bin",
      "parent/scenes/../secret.bin",
      "sub%20dir/root/etc/passwd",
      "sub%20dir/root" + top + "/secret.bin",
      "sub%20dir/",
      std::string(100'000, 'a'),
      std::string(50'000, '.') + "/secret.bin",
      "data:",
      "data:;base64",
      "data:;base64,../secret.bin",
      "data:text/plain," + top,
  };
  static_assert(std::size(ways) >= 30);
  for (const std::string& way : ways) {
    try {
      read_corners(scene(way));
      ADD_FAILURE() << way.substr(0, 80) << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      EXPECT_LT(std::string(error.what()).size(), 400u);
    }
  }
}

TEST_F(GltfUri, OnlyRegularFilesAreRead) {
  ASSERT_EQ(mkfifo((folder_.path() + "/scenes/pipe.bin").c_str(), 0600), 0);
  EXPECT_THAT(failure(scene("pipe.bin")), HasSubstr("regular file"));
  EXPECT_THAT(failure(scene("sub%20dir")), HasSubstr("is a folder"));
  EXPECT_THAT(failure(scene("missing.bin")), HasSubstr("does not exist"));
  EXPECT_THAT(failure(scene("a%zz.bin")), HasSubstr("\"a%zz.bin\", which does not exist"));
}

TEST_F(GltfUri, LinksInsideTheFolderAreFollowed) {
  place("scenes/a.bin");
  std::filesystem::create_symlink("a.bin", folder_.path() + "/scenes/link.bin");
  EXPECT_EQ(read_corners(scene("link.bin")).size(), 3u);
}

TEST_F(GltfUri, ABufferShorterThanItSaysIsAnError) {
  folder_.write("scenes/short.bin", gltf_.bytes.substr(1));
  EXPECT_THAT(failure(scene("short.bin")), HasSubstr("only"));
}

TEST_F(GltfUri, BuffersMayBeEmbeddedAsBase64) {
  // The 9 floats of the triangle 0 0 0, 1 0 0, 0 1 0 and its indices 0 1 2.
  EXPECT_EQ(read_corners(scene("data:application/octet-stream;base64,"
                               "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA")),
            (CornerList{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_THAT(failure(scene("data:;base64,AAA!")), HasSubstr("base64"));
  EXPECT_THAT(failure(scene("data:,AAAA")), HasSubstr("base64"));
  EXPECT_THAT(failure(scene("data:;base64,AAAA")), HasSubstr("only 3 are there"));
}

TEST(GltfHostile, EveryTruncationIsAnError) {
  const TempFolder folder;
  const std::string whole = indexed_triangle().glb();
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(failure(folder.write("cut.glb", whole.substr(0, size))), "") << size;
  }
}

TEST(GltfHostile, HugeCountsAreRefusedBeforeAllocation) {
  for (const uint64_t count : {uint64_t(4), uint64_t(1) << 31, (uint64_t(1) << 32) - 1,
                               uint64_t(1) << 60, UINT64_MAX / 12 + 2, UINT64_MAX}) {
    GltfBuilder gltf = indexed_triangle();
    gltf.json["accessors"][0]["count"] = count;
    EXPECT_THAT(failure(gltf), HasSubstr("does not fit")) << count;
    if (count == 4) continue;
    gltf.json["accessors"][0].erase("bufferView");
    EXPECT_THAT(failure(gltf), HasSubstr("without data")) << count;
  }
}

TEST(GltfHostile, ViewsAndStridesMustFit) {
  for (const char* key : {"byteOffset", "byteLength"}) {
    for (const uint64_t value : {uint64_t(1000), uint64_t(1) << 63, UINT64_MAX}) {
      GltfBuilder gltf = indexed_triangle();
      gltf.json["bufferViews"][0][key] = value;
      EXPECT_THAT(failure(gltf), HasSubstr("outside its buffer")) << key << value;
    }
  }
  for (const uint64_t stride : {uint64_t(1), uint64_t(13), UINT64_MAX}) {
    GltfBuilder gltf = indexed_triangle();
    gltf.json["bufferViews"][0]["byteStride"] = stride;
    EXPECT_THAT(failure(gltf), HasSubstr("does not fit")) << stride;
  }
  GltfBuilder gltf = indexed_triangle();
  gltf.json["accessors"][0]["byteOffset"] = UINT64_MAX - 3;
  EXPECT_THAT(failure(gltf), HasSubstr("does not fit"));
}

TEST(GltfHostile, VertexIndicesMustBeInTheMesh) {
  GltfBuilder gltf;
  const int positions = gltf.accessor(kTriangle, "VEC3");
  gltf.show(gltf.mesh(positions, gltf.accessor(std::vector<uint32_t>{0, 1, 3}, "SCALAR")));
  EXPECT_THAT(failure(gltf), HasSubstr("vertex index 3"));
}

TEST(GltfHostile, ReferencesMustExist) {
  const auto breaks = [](const json::json_pointer& where, const json& value, const char* sentence) {
    GltfBuilder gltf = indexed_triangle();
    gltf.json[where] = value;
    EXPECT_THAT(failure(gltf), HasSubstr(sentence)) << where.to_string();
  };
  using P = json::json_pointer;
  breaks(P("/scene"), 1, "scenes[1]");
  breaks(P("/scenes/0/nodes/0"), 7, "nodes[7]");
  breaks(P("/nodes/0/mesh"), 7, "meshes[7]");
  breaks(P("/nodes/0/mesh"), -1, "\"mesh\" is not a whole number");
  breaks(P("/nodes/0/children"), "none", "\"children\" is not an array");
  breaks(P("/meshes/0/primitives/0/attributes/POSITION"), 7, "accessors[7]");
  breaks(P("/meshes/0/primitives/0/indices"), 0, "type SCALAR");
  breaks(P("/meshes/0/primitives/0/mode"), 7, "mode");
  breaks(P("/accessors/0/bufferView"), 7, "bufferViews[7]");
  breaks(P("/accessors/0/componentType"), 5130, "5130");
  breaks(P("/accessors/0/componentType"), 5125, "component type");
  breaks(P("/accessors/1/componentType"), 5122, "unsigned");
  breaks(P("/bufferViews/0/buffer"), 1, "buffers[1]");
  breaks(P("/nodes/0/translation"), {1, 2}, "\"translation\"");
  breaks(P("/nodes/0"), 3, "object");
}

TEST(GltfHostile, ARequiredExtensionThatChangesGeometryIsNamed) {
  GltfBuilder gltf = indexed_triangle();
  gltf.json["extensionsRequired"] = {"KHR_materials_unlit", "EXT_future_compression"};
  EXPECT_THAT(failure(gltf), HasSubstr("EXT_future_compression"));
  gltf.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
  EXPECT_EQ(read_corners(gltf).size(), 3u);
  gltf.json["extensionsRequired"] = json::array();
  gltf.json["extensionsUsed"] = {"EXT_future_compression", "ACME_anything"};
  EXPECT_EQ(read_corners(gltf).size(), 3u);
}

TEST(GltfHostile, WhatIsNotGltf2IsRefused) {
  const TempFolder folder;
  GltfBuilder gltf = indexed_triangle();
  gltf.json["asset"]["version"] = "1.0";
  EXPECT_THAT(failure(gltf), HasSubstr("glTF 2"));
  EXPECT_THAT(failure(folder.write("a.gltf", "[]")), HasSubstr("object"));
  EXPECT_THAT(failure(folder.write("a.gltf", "{\"asset\":")), HasSubstr("JSON"));
  EXPECT_THAT(failure(folder.write("a.gltf", "{\"x\": 1e999}")), HasSubstr("JSON"));
  EXPECT_THAT(failure(folder.write("a.gltf", std::string(1000000, '['))), HasSubstr("deep"));
  EXPECT_THAT(failure(folder.write("a.gltf", "{\"a\":" + std::string(1000000, '['))),
              HasSubstr("deep"));
}

TEST(GltfHostile, ABudgetIsKeptAndGivenBack) {
  GltfBuilder gltf;
  const int positions = gltf.accessor(std::vector<float>(3 * 100000, 1.0f), "VEC3");
  gltf.show(gltf.mesh(positions, gltf.accessor(std::vector<uint32_t>{0, 1, 2}, "SCALAR")));
  const TempFolder folder;
  const File file = File::open_read(folder.write("a.glb", gltf.glb()));
  const NameFilter all;
  MemoryBudget small(uint64_t(1) << 20);
  try {
    read_meshes(read_gltf, file, {&all, false, &small}, [](const TriangleBatch&) {});
    FAIL() << "100000 vertices do not fit in one MiB";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kMemory);
  }
  EXPECT_EQ(small.used(), 0u);
}

}  // namespace
}  // namespace svdag
