// A scene of a few triangles takes memory for a few: libraries and farms read thousands of such
// files.
#include <malloc.h>

#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

uint64_t heap_bytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

// The memory of a reader while it passes on the triangles of `text`.
uint64_t held_by(MeshReader reader, std::string_view text) {
  const MemoryFile memory(text);
  MemoryBudget budget;
  const NameFilter names;
  const uint64_t before = heap_bytes();
  uint64_t most = 0;
  read_meshes(reader, memory.file(), {&names, false, &budget},
              [&](const TriangleBatch&) { most = std::max(most, heap_bytes() - before); });
  EXPECT_LT(budget.peak(), 8192U);  // a polygon has room for 64 corners
  return most;
}

TEST(SmallScene, TakesLittleMemoryInEveryFormat) {
  constexpr uint64_t kLittle = 32 << 10;
  EXPECT_LT(held_by(read_off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), kLittle);
  EXPECT_LT(held_by(read_obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), kLittle);
  EXPECT_LT(held_by(read_stl,
                    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                    "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"),
            kLittle);
  EXPECT_LT(held_by(read_ply,
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            kLittle);
}

TEST(SmallScene, BatchesAreFullWhereThereAreMoreTriangles) {
  constexpr uint64_t kTriangles = 2 * BatchWriter::kBatch + 100;
  std::vector<uint64_t> sizes;
  std::vector<double> order;
  const TriangleSink sink = [&](const TriangleBatch& batch) {
    sizes.push_back(batch.triangles.size());
    for (const Triangle& t : batch.triangles) order.push_back(t.v[0].x);
  };
  BatchWriter writer(sink);
  for (uint64_t i = 0; i < kTriangles; ++i) writer.add({double(i), 0, 0}, {}, {});
  writer.flush();
  EXPECT_EQ(sizes, (std::vector<uint64_t>{BatchWriter::kBatch, BatchWriter::kBatch, 100}));
  for (uint64_t i = 0; i < kTriangles; ++i) ASSERT_EQ(order.at(i), double(i));
}

}  // namespace
}  // namespace svdag
