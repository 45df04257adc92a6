// Positions that are spilled and joined give what positions in memory give: the same triangles bit
// by bit, in order, with the same names and numbers, and the same error behind the same triangles.
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/io/scene/mesh/test_spill.h"
#include "tests/io/scene/random_mesh.h"

namespace svdag {
namespace {

using Random = std::mt19937_64;

constexpr uint64_t kMinShare = 16 * 4096;

uint64_t random_share(Random& random) {
  return kMinShare + random() % (3 * kMinShare);
}

// Vertices that share^2 / 8b bytes hold, and fewer.
uint32_t random_vertices(Random& random, uint64_t share) {
  const uint64_t most = share * share / (8 * 4096) / (3 * sizeof(double));
  return uint32_t(1 + (random() % 4 == 0 ? random() % 50 : random() % most));
}

// Every second one is cut short or has a digit or byte changed, mostly behind the middle.
std::string perhaps_broken(Random& random, int round, std::string bytes) {
  const uint64_t half = bytes.size() / 2;
  const int what = round % 6;
  const uint64_t place = random() % half + (random() % 4 != 0 ? half : 0);
  if (what == 0) bytes.resize(place);
  if (what == 1) bytes[place] = char('0' + random() % 10);
  if (what == 2) bytes[place] = char(random());
  return bytes;
}

// Counts what the random cases were, so that none of them is missing.
struct Tally {
  int refused = 0, late = 0;  // late: with triangles before the error
  size_t triangles = 0;

  void count(const Outcome& outcome) {
    refused += !outcome.error.empty();
    late += !outcome.error.empty() && !outcome.triangles.empty();
    triangles += outcome.triangles.size() / 11;
  }
  void expect_enough() const {
    EXPECT_GE(refused, 2);
    EXPECT_GE(late, 1);
    EXPECT_GE(triangles, 100000U);
  }
};

template <class Write>
void compare_random_meshes(MeshReader reader, uint64_t seed, int rounds, const Write& write) {
  Random random(seed);
  Tally tally;
  for (int round = 0; round < rounds && !::testing::Test::HasFailure(); ++round) {
    SCOPED_TRACE(round);
    const uint64_t share = random_share(random);
    const RandomMesh mesh(random, random_vertices(random, share), 5000 + random() % 15000);
    const std::string bytes = perhaps_broken(random, round, write(mesh, random));
    tally.count(expect_same_when_spilled(reader, bytes, share));
  }
  tally.expect_enough();
}

TEST(Spilled, TextPly) {
  compare_random_meshes(read_ply, 1, 16, [](const RandomMesh& mesh, Random& random) {
    return mesh.ply(random, "ascii");
  });
}

TEST(Spilled, LittleEndianPly) {
  compare_random_meshes(read_ply, 2, 24, [](const RandomMesh& mesh, Random& random) {
    return mesh.ply(random, "binary_little_endian");
  });
}

TEST(Spilled, BigEndianPly) {
  compare_random_meshes(read_ply, 3, 16, [](const RandomMesh& mesh, Random& random) {
    return mesh.ply(random, "binary_big_endian");
  });
}

TEST(Spilled, Off) {
  compare_random_meshes(read_off, 4, 16,
                        [](const RandomMesh& mesh, Random&) { return mesh.off(); });
}

TEST(Spilled, Obj) {
  compare_random_meshes(read_obj, 5, 24,
                        [](const RandomMesh& mesh, Random& random) { return mesh.obj(random); });
}

// The share holds some chunks of positions: they are in memory first and leave it later, in OBJ
// after triangles that were passed on already.
TEST(Spilled, PositionsLeaveMemoryInTheMiddleOfAFile) {
  Random random(6);
  for (int round = 0; round < 2; ++round) {
    const RandomMesh mesh(random, 150000, 50000);
    const uint64_t share = (uint64_t(2) << 20) + random() % (1 << 20);
    expect_same_when_spilled(read_obj, mesh.obj(random), share);
    expect_same_when_spilled(read_off, mesh.off(), share);
    expect_same_when_spilled(read_ply, mesh.ply(random, "binary_little_endian"), share / 2);
  }
}

TEST(Spilled, GltfWithInstancesAndEveryMode) {
  Random random(7);
  for (const int mode : {4, 5, 6}) {
    for (const bool broken : {false, true}) {
      const RandomMesh mesh(random, 9000, 0);
      std::vector<float> positions;
      for (const auto& v : mesh.vertices) positions.insert(positions.end(), v.begin(), v.end());
      std::vector<uint32_t> indices(60000);
      for (uint32_t& i : indices) i = uint32_t(random() % mesh.vertices.size());
      if (broken) indices[indices.size() / 2] = 9000;
      GltfBuilder gltf;
      const int shape =
          gltf.mesh(gltf.accessor(positions, "VEC3"), gltf.accessor(indices, "SCALAR"), mode);
      const std::vector<float> offsets = {1, 2, 3, -0.1F, 7, 1e-3F};
      const nlohmann::json instancing = {
          {"EXT_mesh_gpu_instancing",
           {{"attributes", {{"TRANSLATION", gltf.accessor(offsets, "VEC3")}}}}}};
      gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
      gltf.scene({gltf.append("nodes", {{"name", "one"}, {"mesh", shape}, {"scale", {3, 0.3, 1}}}),
                  gltf.append("nodes", {{"mesh", shape}, {"extensions", instancing}})});
      const Outcome outcome = expect_same_when_spilled(read_gltf, gltf.glb(), kMinShare, 1 << 20);
      EXPECT_EQ(outcome.error.empty(), !broken);
      EXPECT_GE(outcome.triangles.size() / 11, broken ? 4096U : 60000U);
    }
  }
}

TEST(Spilled, TheBlocksOfAMeshAreFreeForTheNext) {
  Random random(8);
  const RandomMesh mesh(random, 5000, 20000);
  const MemoryFile whole(mesh.obj(random)), broken(mesh.obj(random) + "f 1 2 x\n");
  for (const MemoryFile* memory : {&whole, &broken}) {
    MemoryBudget budget;
    TestSpill spill(kMinShare);
    outcome_of(read_obj, memory->file(), &budget, spill.space());
    const uint64_t peak = spill.file()->peak_bytes();
    outcome_of(read_obj, memory->file(), &budget, spill.space());
    EXPECT_EQ(spill.file()->peak_bytes(), peak);
  }
}

// A file of `vertices` vertices and triangles of their numbers modulo that.
std::string tall_off(uint64_t vertices, const std::vector<uint64_t>& corners = {0, 1, 2}) {
  std::string text =
      "OFF\n" + std::to_string(vertices) + " " + std::to_string(corners.size() / 3) + " 0\n";
  for (uint64_t i = 0; i < vertices; ++i) text += std::to_string(i) + " 0 0\n";
  for (size_t c = 0; c < corners.size(); ++c)
    text += (c % 3 == 0 ? "3 " : "") + std::to_string(corners[c] % vertices) +
            (c % 3 == 2 ? "\n" : " ");
  return text;
}

// As in a scan: neither recorded nor joined.
TEST(Spilled, OfFacesInTheOrderOfTheVerticesOnlyTheVerticesAreSpilled) {
  std::vector<uint64_t> corners;
  for (uint64_t i = 0; i + 201 < 100000; ++i) corners.insert(corners.end(), {i, i + 1, i + 200});
  const std::string bytes = tall_off(100000, corners);
  expect_same_when_spilled(read_off, bytes, kMinShare);
  const MemoryFile memory(bytes);
  MemoryBudget budget;
  TestSpill spill(kMinShare);
  outcome_of(read_off, memory.file(), &budget, spill.space());
  EXPECT_LE(spill.file()->peak_bytes(), 100000 * 3 * sizeof(double) * 11 / 10);
  EXPECT_LE(spill.file()->read_bytes(), spill.file()->written_bytes());
}

TEST(Spilled, MoreVerticesThanTheShareCanJoinAreAMemoryErrorThatSaysSo) {
  Random random(9);
  std::vector<uint64_t> corners(30000);
  for (uint64_t& corner : corners) corner = random();
  const MemoryFile memory(tall_off(100000, corners));
  MemoryBudget budget;
  TestSpill spill(kMinShare);
  const Outcome outcome = outcome_of(read_off, memory.file(), &budget, spill.space());
  EXPECT_EQ(outcome.code, ExitCode::kMemory);
  EXPECT_NE(outcome.error.find("raise --memory"), std::string::npos) << outcome.error;
  EXPECT_EQ(budget.used(), 0U);
}

TEST(Spilled, WithoutASpillFileItIsAMemoryErrorAsBefore) {
  const MemoryFile memory(tall_off(100000));
  MemoryBudget budget(kMinShare);
  EXPECT_EQ(outcome_of(read_off, memory.file(), &budget).code, ExitCode::kMemory);
}

TEST(Spilled, AMeshThatFitsOpensNoFile) {
  const MemoryFile memory(tall_off(1000));
  MemoryBudget budget;
  TestSpill spill(uint64_t(1) << 20);
  outcome_of(read_off, memory.file(), &budget, spill.space());
  EXPECT_EQ(spill.file(), nullptr);
}

}  // namespace
}  // namespace svdag
