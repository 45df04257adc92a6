#ifdef SVDAG_HAS_UFBX
#include <string>

#include "tests/io/scene/read_text.h"

namespace svdag {
namespace {

// A scene of one triangle; `properties`: of its node.
std::string fbx_text(const std::string& properties = "") {
  return "; FBX 7.4.0 project file\n"
         "FBXHeaderExtension: {\n FBXVersion: 7400\n}\n"
         "Objects: {\n"
         " Geometry: 1, \"Geometry::g\", \"Mesh\" {\n"
         "  Vertices: *9 {\n a: 0,0,0,1,0,0,1,1,0\n }\n"
         "  PolygonVertexIndex: *3 {\n a: 0,1,-3\n }\n }\n"
         " Model: 2, \"Model::a\", \"Mesh\" {\n  Properties70: {\n" +
         properties +
         "  }\n }\n}\n"
         "Connections: {\n C: \"OO\",2,0\n C: \"OO\",1,2\n}\n";
}

TEST(Fbx, ReadsNamesAndPositions) {
  const Reading reading = read(read_fbx, fbx_text());
  ASSERT_EQ(reading.triangles.size(), 1U);
  EXPECT_EQ(reading.triangles[0], kLower);
  EXPECT_EQ(reading.meshes[0], "a");
}

TEST(Fbx, AMirroredNodeKeepsTheOutsideOutside) {
  const Reading reading =
      read(read_fbx, fbx_text("P: \"Lcl Scaling\", \"Lcl Scaling\", \"\", \"A\",-1,1,1\n"));
  ASSERT_EQ(reading.triangles.size(), 1U);
  const Corners& t = reading.triangles[0];
  const double normal =
      (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
  EXPECT_GT(normal, 0);
}

TEST(Fbx, PositionsAreDoubles) {
  const Reading reading =
      read(read_fbx,
           fbx_text("P: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",16777217.25,0,0\n"));
  ASSERT_EQ(reading.triangles.size(), 1U);
  EXPECT_EQ(reading.triangles[0][0][0], 16777217.25);
}

TEST(Fbx, ATextThatIsCutOffIsRefused) {
  const std::string whole = fbx_text();
  const size_t connections = whole.find("Connections");
  for (size_t size = connections + 14; size + 2 < whole.size(); ++size)
    EXPECT_NE(refusal(read_fbx, whole.substr(0, size)).find("ends too early"), std::string::npos)
        << size;
}

TEST(Fbx, ACornerWithoutAVertexIsRefused) {
  std::string bad = fbx_text();
  bad.replace(bad.find("0,1,-3"), 6, "0,9,-3");
  EXPECT_NE(refusal(read_fbx, bad).find("is not a valid FBX file"), std::string::npos);
}

}  // namespace
}  // namespace svdag
#endif
