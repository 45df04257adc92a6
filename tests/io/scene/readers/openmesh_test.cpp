// OpenMesh files, and OpenMesh as the judge of the mesh diagnostics.
#ifdef SVDAG_HAS_OPENMESH
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <cmath>

#include "io/scene/mesh_stats.h"
#include "tests/io/scene/gltf/gltf_builder.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<Traits>;
using testing::HasSubstr;

// A wavy sheet of n x n quads with every third quad missing where `holes`.
Mesh sheet(int n, bool holes) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> v;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) v.push_back(mesh.add_vertex({x / 3.0, y / 7.0, std::sin(x + y)}));
  }
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const size_t i = size_t(y * (n + 1) + x), up = i + size_t(n) + 1;
      if (holes && x % 3 == 1 && y % 3 == 1) continue;
      mesh.add_face(v[i], v[i + 1], v[up + 1], v[up]);
    }
  }
  return mesh;
}

std::string save(const TempFolder& folder, const Mesh& mesh) {
  const std::string path = folder.path() + "/mesh.om";
  omlog().disable();
  EXPECT_TRUE(
      OpenMesh::IO::write_mesh(mesh, path, OpenMesh::IO::Options(OpenMesh::IO::Options::Binary)));
  return path;
}

CornerList read_om(const std::string& path, bool sandbox = false) {
  MemoryBudget budget(uint64_t(1) << 28);
  const NameFilter all;
  CornerList corners;
  ReadOptions options{&all, false, &budget};
  options.sandbox = sandbox;
  read_meshes(read_openmesh, File::open_read(path), options, [&](const TriangleBatch& batch) {
    for (const Triangle& t : batch.triangles) {
      for (const Point& p : t.v) corners.push_back({p.x, p.y, p.z});
    }
  });
  return corners;
}

TEST(OpenMesh, PolygonsComeAsFansOfTheirExactDoubles) {
  Mesh mesh;
  const auto p = [](double x, double y) { return OpenMesh::Vec3d(x / 3, y / 3, 1e-9); };
  const auto a = mesh.add_vertex(p(0, 0)), b = mesh.add_vertex(p(2, 0)),
             c = mesh.add_vertex(p(3, 1)), d = mesh.add_vertex(p(2, 2)),
             e = mesh.add_vertex(p(0, 2));
  mesh.add_face(std::vector<Mesh::VertexHandle>{a, b, c, d, e});
  const TempFolder folder;
  const CornerList corners = read_om(save(folder, mesh));
  ASSERT_EQ(corners.size(), 9u);
  double area = 0;
  for (size_t i = 0; i < 9; i += 3) {
    EXPECT_EQ(corners[i], corners[0]);  // one fan
    area += (corners[i + 1][0] - corners[i][0]) * (corners[i + 2][1] - corners[i][1]) -
            (corners[i + 1][1] - corners[i][1]) * (corners[i + 2][0] - corners[i][0]);
    for (size_t k = i; k < i + 3; ++k) EXPECT_EQ(corners[k][2], 1e-9);
  }
  EXPECT_NEAR(area, 2 * 5.0 / 9, 1e-12);
}

TEST(OpenMesh, ConcavePolygonsAreFilledInsideOfTheirOutline) {
  Mesh mesh;
  std::vector<Mesh::VertexHandle> dart;
  for (const auto& [x, y] : {std::pair(4, 0), {0, 1}, {-4, 0}, {0, 4}})
    dart.push_back(mesh.add_vertex({double(x), double(y), 0}));
  mesh.add_face(dart);
  const TempFolder folder;
  const CornerList corners = read_om(save(folder, mesh));
  ASSERT_EQ(corners.size(), 6u);
  double area = 0;
  for (size_t i = 0; i < 6; i += 3) {
    area += std::abs((corners[i + 1][0] - corners[i][0]) * (corners[i + 2][1] - corners[i][1]) -
                     (corners[i + 1][1] - corners[i][1]) * (corners[i + 2][0] - corners[i][0]));
  }
  EXPECT_EQ(area, 2 * 12);
}

TEST(OpenMesh, ALimitedChildReadsTheSame) {
  const TempFolder folder;
  const std::string path = save(folder, sheet(100, true));
  const CornerList corners = read_om(path);
  EXPECT_GT(corners.size(), 3 * BatchWriter::kBatch);
  EXPECT_EQ(read_om(path, true), corners);
}

TEST(OpenMesh, ACutFileIsAnError) {
  const TempFolder folder;
  const std::string path = save(folder, sheet(5, false));
  const auto size = std::filesystem::file_size(path);
  for (uintmax_t cut : {uintmax_t(0), uintmax_t(8), uintmax_t(16), size / 2, size - 40}) {
    std::filesystem::resize_file(path, cut);
    EXPECT_THROW(read_om(path), Error) << cut;
    EXPECT_THROW(read_om(path, true), Error) << cut;
    save(folder, sheet(5, false));
  }
}

TEST(OpenMesh, AHugeCountIsRefusedBeforeAllocation) {
  const TempFolder folder;
  std::string bytes("OMP\x14", 4);
  bytes += GltfBuilder::u32(0xfffffff0) + GltfBuilder::u32(0xfffffff0) + GltfBuilder::u32(7);
  try {
    read_om(folder.write("huge.om", bytes));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_THAT(error.what(), HasSubstr("cut off"));
  }
}

TEST(OpenMesh, AgreesWithTheDiagnosticsOnManifoldMeshes) {
  for (const bool holes : {false, true}) {
    const Mesh mesh = sheet(21, holes);
    uint64_t boundary = 0;
    for (const auto edge : mesh.edges()) boundary += mesh.is_boundary(edge);
    const TempFolder folder;
    MemoryBudget budget;
    const Scene scene({{save(folder, mesh)}, {}, false}, &budget);
    const MeshStats stats = compute_mesh_stats(scene, &budget);
    EXPECT_EQ(stats.open_edges, boundary);
    EXPECT_EQ(stats.positions, mesh.n_vertices());
    EXPECT_EQ(stats.triangles, 2 * mesh.n_faces());
    EXPECT_EQ(stats.non_manifold_edges, 0u);
  }
}

}  // namespace
}  // namespace svdag
#endif
