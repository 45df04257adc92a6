// Gzip files are unpacked as gunzip does.
#include "io/scene/decoders/gzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "io/scene/scene.h"
#include "tests/expect_error.h"
#include "tests/io/scene/mesh/test_spill.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

std::string packed(const std::string& text, int level = 6) {
  z_stream state{};
  deflateInit2(&state, level, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&state, text.size()) + 64, '\0');
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  state.avail_in = uInt(text.size());
  state.next_out = reinterpret_cast<Bytef*>(out.data());
  state.avail_out = uInt(out.size());
  EXPECT_EQ(deflate(&state, Z_FINISH), Z_STREAM_END);
  out.resize(state.total_out);
  deflateEnd(&state);
  return out;
}

std::string random_letters(size_t size, char values) {
  std::mt19937 random(5);
  std::string text(size, ' ');
  for (char& c : text) c = char(random() % uint32_t(values));
  return text;
}

class Gzip : public testing::Test {
 protected:
  std::string unpacked(const std::string& bytes) {
    File out = File::create_anonymous(folder_.path());
    unpack_gzip(File::open_read(folder_.write("a.ply.gz", bytes)), &out);
    std::string text(out.size(), ' ');
    out.read_at(0, std::as_writable_bytes(std::span(text)));
    return text;
  }
  TempFolder folder_;
};

TEST_F(Gzip, GivesTheContentOfAnySizeAndLevel) {
  for (const size_t size :
       {size_t(0), size_t(1), size_t(1) << 18, (size_t(1) << 18) + 1, size_t(3000000)}) {
    for (const int level : {0, 1, 9}) {
      const std::string text = random_letters(size, level == 0 ? 127 : 4);
      EXPECT_EQ(unpacked(packed(text, level)), text) << size << " " << level;
    }
  }
}

TEST_F(Gzip, AppendsMembersAndIgnoresWhatIsNotOne) {
  EXPECT_EQ(unpacked(packed("one ") + packed("") + packed("two")), "one two");
  EXPECT_EQ(unpacked(packed("one") + std::string(512, '\0')), "one");
}

TEST_F(Gzip, TheStartIsUnpackedAlone) {
  const auto start = [&](const std::string& bytes) {
    std::string out(8, '?');
    const size_t n = unpack_start(File::open_read(folder_.write("a.gz", bytes)),
                                  std::as_writable_bytes(std::span(out)));
    return out.substr(0, n);
  };
  EXPECT_EQ(start(packed("glTF and more, " + random_letters(1000000, 100))), "glTF and");
  EXPECT_EQ(start(packed("OFF")), "OFF");
  EXPECT_EQ(start(packed("")), "");
  EXPECT_EQ(start("\x1f\x8b\x08 damaged"), "");
}

TEST_F(Gzip, DamageIsAnError) {
  const std::string text = random_letters(100000, 16), bytes = packed(text);
  for (size_t size = 2; size < bytes.size(); size += 997)
    EXPECT_SVDAG_ERROR(unpacked(bytes.substr(0, size)), ExitCode::kBadInput, "ends too early");
  int found = 0;
  for (size_t at = 20; at < bytes.size(); at += 997) {  // the checksum is the last resort
    std::string wrong = bytes;
    wrong[at] = char(wrong[at] ^ 0x10);
    try {
      unpacked(wrong);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      ++found;
    }
  }
  EXPECT_EQ(found, int((bytes.size() - 20 + 996) / 997));
}

// Zeros expand a thousandfold: the disk is not filled first.
TEST_F(Gzip, ContentWithoutRoomIsAnErrorBeforeItIsWritten) {
  const File bomb =
      File::open_read(folder_.write("a.ply.gz", packed(std::string(5'000'000, '\0'))));
  File out = File::create_anonymous(folder_.path());
  EXPECT_SVDAG_ERROR(unpack_gzip(bomb, &out, {"/full", 1'000'000}), ExitCode::kOutput,
                     "/full: has no room for the content of " + bomb.path());
  EXPECT_LE(out.size(), 1'000'000U);
}

TEST_F(Gzip, ASceneIsReadAsIfUnpackedAndUnpackedOnce) {
  const std::string obj = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 5\nf 1 2 3\n";
  MemoryBudget budget;
  const SceneConfig config = {.paths = {folder_.write("scene.OBJ.GZ", packed(obj))}, .names = {}};
  const TestSpill vertices(uint64_t(1) << 20);
  SpillSpace spill = *vertices.space();
  spill.unpack_folder = folder_.path();
  const Scene scene(config, &budget, &spill);
  const Box box = scene.bounds();
  EXPECT_EQ(box.max, Point(1, 1, 5));
  uint64_t triangles = 0;
  EXPECT_EQ(scene.stream([&](const TriangleBatch& batch) { triangles += batch.triangles.size(); })
                .triangles,
            1U);
  EXPECT_EQ(triangles, 1U);
  EXPECT_EQ(folder_.entries(), 1U);  // the unpacked file has no name
}

}  // namespace
}  // namespace svdag
