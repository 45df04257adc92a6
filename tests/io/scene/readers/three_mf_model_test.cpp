#ifdef SVDAG_HAS_3MF
#include "io/scene/readers/three_mf_model.h"

#include <gtest/gtest.h>

#include <string>

#include "streaming/error.h"

namespace svdag {
namespace {

// Passed on byte by byte, so that every token is divided.
ThreeMfModel parse_model(const std::string& xml) {
  return parse_three_mf_model(
      [&](const auto& sink) {
        for (const char& c : xml) sink(std::string_view(&c, 1), false);
        sink({}, true);
      },
      "a.3mf");
}

std::string model_refusal(const std::string& xml) {
  try {
    parse_model(xml);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "was read: " << xml;
  return {};
}

std::string model_xml(const std::string& mesh) {
  return "<model unit='inch'><resources><object id='7' name='n'><mesh><vertices>"
         "<vertex x='0.1' y='-1e2' z='+3'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/>"
         "</vertices><triangles>" +
         mesh +
         "</triangles></mesh></object></resources><build><item objectid='7'/></build></model>";
}

TEST(ThreeMfModel, ReadsObjects) {
  const ThreeMfModel model = parse_model(model_xml("<triangle v1='0' v2='1' v3='2'/>"));
  EXPECT_EQ(model.unit_metres, 0.0254);
  ASSERT_EQ(model.objects.count(7), 1U);
  const ThreeMfObject& read = model.objects.at(7);
  EXPECT_EQ(read.name, "n");
  ASSERT_EQ(read.vertices.size(), 3U);
  EXPECT_EQ(read.vertices[0].x, 0.1);
  EXPECT_EQ(read.vertices[0].y, -100);
  EXPECT_EQ(read.vertices[0].z, 3);
  EXPECT_EQ(read.triangles.size(), 1U);
  EXPECT_EQ(model.items.size(), 1U);
}

TEST(ThreeMfModel, TransformsAreForRowVectors) {
  const ThreeMfModel model = parse_model(
      "<model><build><item objectid='1' p:path='/3D/a.model' printable='0' "
      "transform='1 2 3 4 5 6 7 8 9 10 11 12'/></build></model>");
  ASSERT_EQ(model.items.size(), 1U);
  const Point p = model.items[0].to_parent({1, 0, 0});
  EXPECT_EQ(p.x, 11);
  EXPECT_EQ(p.y, 13);
  EXPECT_EQ(p.z, 15);
  EXPECT_EQ(model.items[0].part, "3D/a.model");
  EXPECT_FALSE(model.items[0].is_printable);
}

TEST(ThreeMfModel, RefusesWhatIsDamaged) {
  const std::string triangle = "<triangle v1='0' v2='1' v3='2'/>";
  EXPECT_NE(model_refusal(model_xml("<triangle v1='0' v2='1' v3='3'/>")).find("vertex 3, but 3"),
            std::string::npos);
  EXPECT_NE(model_refusal(model_xml("<triangle v1='0' v2='-1' v3='2'/>")).find("\"-1\""),
            std::string::npos);
  EXPECT_NE(model_refusal(model_xml("<triangle v1='0' v2='1'/>")).find("v3"), std::string::npos);
  EXPECT_NE(model_refusal("<!DOCTYPE model [<!ENTITY a 'b'>]>" + model_xml(triangle))
                .find("document type"),
            std::string::npos);
  EXPECT_NE(model_refusal("<model unit='ell'/>").find("unknown unit"), std::string::npos);
  const std::string whole = model_xml(triangle);
  for (size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(model_refusal(whole.substr(0, size)), "") << size;
}

}  // namespace
}  // namespace svdag
#endif
