// Closed surfaces have no boundary; T-junctions exactly on an edge do not open them.
#include "io/scene/boundary_chain.h"

#include <gtest/gtest.h>

#include <random>

namespace svdag {
namespace {

using LatticeMesh = std::vector<LatticeTriangle>;

LatticeMesh tetrahedron(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                 const LatticePoint& d) {
  return {{{a, b, c}}, {{b, a, d}}, {{c, b, d}}, {{a, c, d}}};
}

template <class Sum>
Sum sum_of(const LatticeMesh& mesh) {
  Sum sum;
  for (const LatticeTriangle& t : mesh) sum.add(t);
  return sum;
}

bool is_closed(const LatticeMesh& mesh) {
  return sum_of<BoundaryChain>(mesh).is_closed();
}

LatticePoint random_point(std::mt19937_64* random, int bits) {
  LatticePoint p;
  for (int a = 0; a < 3; ++a) p[a] = int64_t((*random)()) >> (64 - bits);
  return p;
}

TEST(BoundaryChain, VanishesForSolidsOfAnySizeAndOrder) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    LatticeMesh mesh;
    for (int k = 0; k < 3; ++k) {
      const int bits = 3 + int(random() % 59);
      const auto p = [&] { return random_point(&random, bits); };
      for (const LatticeTriangle& t : tetrahedron(p(), p(), p(), p())) mesh.push_back(t);
    }
    std::shuffle(mesh.begin(), mesh.end(), random);
    ASSERT_TRUE(is_closed(mesh));
    ASSERT_TRUE(sum_of<EdgeSum>(mesh).is_closed());
    const LatticeTriangle last = mesh.back();
    mesh.pop_back();
    // A triangle of zero area has no boundary.
    const LatticePoint p = last.v[1] - last.v[0], q = last.v[2] - last.v[0];
    using Wide = __int128;
    const auto parallel = [&](int a, int b) { return Wide(p[a]) * q[b] == Wide(p[b]) * q[a]; };
    const bool flat = parallel(0, 1) && parallel(1, 2) && parallel(0, 2);
    ASSERT_EQ(is_closed(mesh), flat);
  }
}

TEST(BoundaryChain, AcceptsEdgesThatMatchSeveralShorterOnes) {
  const LatticePoint a(0, 0, 0), b(9, 0, 0), c(0, 9, 0), d(0, 0, 9), third(3, 0, 0), two(6, 0, 0);
  LatticeMesh mesh = tetrahedron(a, b, c, d);
  mesh.erase(mesh.begin());  // a, b, c becomes three triangles with a side on a b
  mesh.insert(mesh.end(), {{{a, third, c}}, {{third, two, c}}, {{two, b, c}}});
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_FALSE(sum_of<EdgeSum>(mesh).is_closed());
  for (LatticeTriangle& t : mesh) {  // one step beside the edge
    for (LatticePoint& p : t.v) {
      if (p == third) p.y = 1;
    }
  }
  EXPECT_FALSE(is_closed(mesh));
}

TEST(BoundaryChain, SumsUpTrianglesOfZeroAreaToNothing) {
  EXPECT_TRUE(is_closed({{{LatticePoint(1, 2, 3), {5, 10, 15}, {3, 6, 9}}}}));
  EXPECT_TRUE(is_closed({{{LatticePoint(1, 2, 3), {1, 2, 3}, {3, 6, 9}}}}));
  EXPECT_TRUE(is_closed({{{LatticePoint(7), LatticePoint(7), LatticePoint(7)}}}));
}

TEST(BoundaryChain, TellsOrientationFromOpenness) {
  LatticeMesh mesh = tetrahedron({0, 0, 0}, {5, 1, 0}, {0, 7, 2}, {1, 1, 9});
  std::swap(mesh[2].v[0], mesh[2].v[1]);
  EXPECT_FALSE(is_closed(mesh));
  EXPECT_TRUE(sum_of<BoundaryChain>(mesh).is_closed_mod_2());
  EXPECT_TRUE(sum_of<EdgeSum>(mesh).is_closed_mod_2());
  // A triangle repeated opens the chain, repeated thrice only its orientation counts.
  LatticeMesh twice = tetrahedron({0, 0, 0}, {5, 1, 0}, {0, 7, 2}, {1, 1, 9});
  twice.push_back(twice[0]);
  EXPECT_FALSE(is_closed(twice));
  EXPECT_FALSE(sum_of<BoundaryChain>(twice).is_closed_mod_2());
  twice.push_back(twice[0]);
  EXPECT_TRUE(sum_of<BoundaryChain>(twice).is_closed_mod_2());
}

}  // namespace
}  // namespace svdag
