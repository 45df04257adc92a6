// The colours of formats beside glTF: where each format has them, and in which range.
#include <gmock/gmock.h>

#include "tests/builder/colours/coloured_scene.h"
#include "tests/io/scene/png_file.h"
#include "tests/io/scene/zip_file.h"

namespace svdag {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SourceColours : public ColouredScene {
 protected:
  static constexpr int kPerUnit = 60;
  // Of the texture, in texels.
  static constexpr int kTexels = 4;

  static Light texel(int i, int j) { return light(20 + 70 * i, 20 + 70 * j, 90); }

  // Its texels, row by row from the top.
  static std::string texture() {
    std::string texels;
    for (int j = 0; j < kTexels; ++j) {
      for (int i = 0; i < kTexels; ++i) texels += rgb(20 + 70 * i, 20 + 70 * j, 90);
    }
    return png(kTexels, kTexels, PngKind::kRgb, texels);
  }

  // Between the centres of texels, v from the top; both of 0 .. 1 are the whole image.
  static Light bilinear(double u, double v, bool clamp = false) {
    const auto wrapped = [&](double i) {
      return int(clamp ? std::min(std::max(i, 0.0), kTexels - 1.0)
                       : i - kTexels * std::floor(i / kTexels));
    };
    const double x = kTexels * u - 0.5, y = kTexels * v - 0.5, i = std::floor(x), j = std::floor(y);
    const double s = x - i, t = y - j;
    Light mix{};
    for (const int a : {0, 1}) {
      for (const int b : {0, 1}) {
        const Light corner = texel(wrapped(i + a), wrapped(j + b));
        for (size_t c = 0; c < 3; ++c) mix[c] += corner[c] * (a ? s : 1 - s) * (b ? t : 1 - t);
      }
    }
    return mix;
  }

  // Unit squares in the plane z = 0, 1.2 apart.
  static Point square(int k) { return Point(1.2 * k, 0, 0); }
  static std::string vertices(int k, const std::string& before = "",
                              const std::string& after = "") {
    std::string lines;
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      lines += before + std::to_string(1.2 * k + x) + " " + std::to_string(y) + " 0" + after + "\n";
    return lines;
  }

  // Where the colour is linear in light, but for bends.
  void expect_light(const Point& p, const Light& expected) const {
    ASSERT_NE(at(p), nullptr) << p.x << " " << p.y;
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR((*at(p))[c], expected[c], 0.015) << p.x << " " << p.y << ", channel " << c;
  }

  void expect_square(int k, const Light& colour, double steps = 0.05) {
    in_square(square(k), [&](double, double, const Point& p) { expect(p, colour, steps); });
  }

  // A square of each material, whose coordinates are x and y; `faces`: of the squares.
  void colour_obj(const std::vector<std::string>& materials, std::vector<std::string> faces = {}) {
    std::string mtl, obj = "mtllib a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 1e300 0\n";
    faces.resize(materials.size(), "f -4/1 -3/2 -2/3 -1/4");
    for (size_t k = 0; k < materials.size(); ++k) {
      const std::string name = "m" + std::to_string(k);
      mtl += "newmtl " + name + "\n" + materials[k];
      obj += vertices(int(k), "v ") + "usemtl " + name + "\n" + faces[k] + "\n";
    }
    folder_.write("a.mtl", mtl);
    colour(folder_.write("a.obj", obj), kPerUnit);
  }
};

TEST_F(SourceColours, MapKdOfObjReplacesKd) {
  folder_.write("two words.png", texture());
  colour_obj({"Kd 0 0 0\nmap_Kd two words.png\n",
              "Kd 1 1 1\nmap_Kd -s 2 0.5 1 -o 0.25 0.5 two words.png\n",
              "map_Kd -clamp on -s 3 3 -o -1 -1 two words.png\n"});
  EXPECT_TRUE(report_.scene.unread_images.empty());
  in_square(square(0),
            [&](double x, double y, const Point& p) { expect_light(p, bilinear(x, 1 - y)); });
  in_square(square(1), [&](double x, double y, const Point& p) {
    expect_light(p, bilinear(2 * x + 0.25, 1 - (0.5 * y + 0.5)));
  });
  in_square(square(2), [&](double x, double y, const Point& p) {
    expect_light(p, bilinear(3 * x - 1, 1 - (3 * y - 1), true));
  });
}

TEST_F(SourceColours, ObjFacesThatAreNowhereInATextureHaveKd) {
  folder_.write("a.png", texture());
  const std::string green = "Kd 0 1 0\nmap_Kd ";
  colour_obj({green + "a.png\n", green + "a.png\n", green + "a.png\n", green + "none.png\n",
              green + "a.png\n"},
             {"f -4 -3 -2 -1", "f -4/1 -3/5 -2/3 -1/4", "f -4/1 -3 -2/3 -1/4",
              "f -4/1 -3/2 -2/3 -1/4", "f -4/1 -3/2 -2/77 -1/4"});
  // The lower right is the triangle of the second corner.
  for (int k = 0; k < 5; ++k) {
    in_square(square(k), [&](double x, double y, const Point& p) {
      if (k == 0 || k >= 3 || x > y + 0.05) expect(p, {0, 1, 0}, 0.05);
    });
  }
  EXPECT_EQ(omissions(Omission::kTexturePoints), 4U);
  EXPECT_THAT(report_.scene.unread_images, ElementsAre(HasSubstr("none.png")));
}

TEST_F(SourceColours, WhatMapDOfObjCutsOutIsInNoMean) {
  // The right half is magenta and transparent.
  std::string texels, mask;
  for (int i = 0; i < 64; ++i) texels += i % 8 < 4 ? rgb(40, 160, 60) : rgb(255, 0, 255);
  for (int i = 0; i < 16; ++i) mask += i % 4 < 2 ? char(255) : char(0);
  folder_.write("a.png", png(8, 8, PngKind::kRgb, texels));
  folder_.write("mask.png", png(4, 4, PngKind::kGrey, mask));
  colour_obj({"map_Kd a.png\nmap_d mask.png\n"});
  int green = 0;
  in_square(square(0), [&](double, double, const Point& p) {
    if (at(p) == nullptr) return;
    ++green;
    expect(p, light(40, 160, 60), 0.05);
  });
  EXPECT_GT(green, kPerUnit * kPerUnit / 3);
  EXPECT_LT(green, kPerUnit * kPerUnit * 2 / 3);
}

TEST_F(SourceColours, ObjColoursOfVerticesMultiplyTheTexture) {
  folder_.write("a.png", one_texel(200, 100, 50));
  folder_.write("a.mtl", "newmtl m\nmap_Kd a.png\n");
  colour(folder_.write("a.obj", "mtllib a.mtl\nvt 0 0\nusemtl m\n" + vertices(0, "v ", " 1 0.5 0") +
                                    "f 1/1 2/1 3/1 4/1\n"),
         kPerUnit);
  expect_square(0, {light(200), light(100) * light(127.5), 0}, 0.5);
}

TEST_F(SourceColours, PlyFacesHaveColoursUnlessVerticesDo) {
  const auto ply = [](const std::string& of_vertices, const std::string& of_faces,
                      const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\n"
           "property float z\n" +
           of_vertices + "element face 3\n" + of_faces + "end_header\n" + body;
  };
  const std::string list = "property list uchar int vertex_indices\n";
  const auto rgb_of = [](const std::string& type) {
    return "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
  };
  const std::string places = vertices(0) + vertices(1) + vertices(2);
  colour(folder_.write("after.ply", ply("", list + rgb_of("uchar"),
                                        places + "4 0 1 2 3 200 100 50\n4 4 5 6 7 1 2 3\n"
                                                 "4 8 9 10 11 1 2 3\n")),
         kPerUnit);
  expect_square(0, light(200, 100, 50));
  expect_square(1, light(1, 2, 3));
  expect_square(2, light(1, 2, 3));
  colour(folder_.write("before.ply",
                       ply("", rgb_of("float") + list,
                           places + "1 0 .2 4 0 1 2 3\n0.5 2 0 4 4 5 6 7\n0 0 0 4 8 9 10 11\n")),
         kPerUnit);
  expect_square(0, light(255, 0, 51));
  expect_square(1, light(128, 255, 0));
  EXPECT_EQ(omissions(Omission::kBrightColours), 1U);
  colour(folder_.write("both.ply", ply(rgb_of("ushort"), list + rgb_of("uchar"),
                                       vertices(0, "", " 65535 0 0") + vertices(1, "", " 0 0 0") +
                                           vertices(2, "", " 0 0 0") +
                                           "4 0 1 2 3 200 100 50\n4 4 5 6 7 1 2 3\n"
                                           "4 8 9 10 11 1 2 3\n")),
         kPerUnit);
  expect_square(0, {1, 0, 0});
}

TEST_F(SourceColours, BinaryPlyFacesHaveColours) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n";
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const int x : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) put(float(x));
  for (const int32_t first : {0, 2}) {
    put(uint8_t(3));
    for (const int32_t i : {first, first + 1, (first + 2) % 4}) put(i);
    for (const int c : {first == 0 ? 250 : 10, 20, 30}) put(uint8_t(c));
  }
  colour(folder_.write("a.ply", bytes), kPerUnit);
  expect(Point(0.75, 0.25, 0.001), light(250, 20, 30), 0.05);
  expect(Point(0.25, 0.75, 0.001), light(10, 20, 30), 0.05);
}

TEST_F(SourceColours, OffColoursAreOfVerticesOrFaces) {
  const std::string places = vertices(0) + vertices(1) + vertices(2) + vertices(3);
  colour(folder_.write("faces.off", "OFF\n16 4 0\n" + places +
                                        "4 0 1 2 3 200 100 50 128\n4 4 5 6 7 0.5 1 0 # half\n"
                                        "4 8 9 10 11 1 0 0\n4 12 13 14 15 7\n"),
         kPerUnit);
  expect_square(0, light(200, 100, 50));
  expect_square(1, light(128, 255, 0));
  expect_square(2, {1, 0, 0});
  expect_square(3, {1, 1, 1});
  EXPECT_EQ(omissions(Omission::kColourIndices), 1U);
  colour(folder_.write("vertices.off", "CNOFF\n8 2 0\n" + vertices(0, "", " 0 0 1 200 100 50 255") +
                                           vertices(1, "", " 0 0 1 0.2 0 2 1") +
                                           "4 0 1 2 3 9 9 9\n4 4 5 6 7\n"),
         kPerUnit);
  expect_square(0, light(200, 100, 50));
  expect_square(1, light(51, 0, 255));
  EXPECT_EQ(omissions(Omission::kBrightColours), 4U);
}

#ifdef SVDAG_HAS_3MF
TEST_F(SourceColours, CornersOfThreeMfHaveColoursOrAPlaceInATexture) {
  std::string places, triangles;
  for (int k = 0; k < 4; ++k) {
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      places +=
          "<vertex x='" + std::to_string(1.2 * k + x) + "' y='" + std::to_string(y) + "' z='0'/>";
  }
  const auto square_of = [&](int k, const std::string& first, const std::string& second) {
    const auto vertex = [&](int i) { return std::to_string(4 * k + i); };
    triangles += "<triangle v1='" + vertex(0) + "' v2='" + vertex(1) + "' v3='" + vertex(2) + "' " +
                 first + "/><triangle v1='" + vertex(0) + "' v2='" + vertex(2) + "' v3='" +
                 vertex(3) + "' " + second + "/>";
  };
  square_of(0, "pid='5' p1='0' p2='1' p3='1'", "pid='5' p1='0' p2='1' p3='0'");
  square_of(1, "pid='6' p1='0' p2='1' p3='2'", "pid='6' p1='0' p2='2' p3='3'");
  square_of(2, "pid='7' p1='0' p2='1' p3='2'", "pid='7' p1='0' p2='2' p3='3'");
  square_of(3, "", "");  // as the object
  const std::string coordinates =
      "<m:tex2coord u='0' v='0'/><m:tex2coord u='1' v='0'/><m:tex2coord u='1' v='1'/>"
      "<m:tex2coord u='0' v='1'/></m:texture2dgroup>";
  const std::string model =
      "<model unit='meter'><resources><m:colorgroup id='5'><m:color color='#ff0000'/>"
      "<m:color color='#0000FF80'/></m:colorgroup>"
      "<m:texture2d id='8' path='/3D/Textures/a.png' contenttype='image/png'/>"
      "<m:texture2d id='9' path='/3D/Textures/none.png' contenttype='image/png'/>"
      "<m:texture2dgroup id='6' texid='8'>" +
      coordinates + "<m:texture2dgroup id='7' texid='9'>" + coordinates +
      "<object id='1' pid='5' pindex='1'><mesh><vertices>" + places + "</vertices><triangles>" +
      triangles +
      "</triangles></mesh></object></resources><build><item objectid='1'/></build></model>";
  colour(
      folder_.write("a.3mf", zip({{"3D/3dmodel.model", model}, {"3D/Textures/a.png", texture()}})),
      kPerUnit);
  // Red at x = 0 and blue at x = 1.
  in_square(square(0), [&](double x, double, const Point& p) { expect(p, {1 - x, 0, x}, 1); });
  in_square(square(1),
            [&](double x, double y, const Point& p) { expect_light(p, bilinear(x, 1 - y)); });
  expect_square(2, {1, 1, 1});
  expect_square(3, {0, 0, 1});
  EXPECT_THAT(report_.scene.unread_images, ElementsAre(HasSubstr("a.3mf: 3D/Textures/none.png")));
}
#endif

#ifdef SVDAG_HAS_UFBX
TEST_F(SourceColours, FbxHasTexturesInTheFileAndColoursOfVertices) {
  const std::string image = texture();
  const auto base64 = [](const std::string& bytes) {
    const std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
      uint32_t group = 0;
      for (size_t k = 0; k < 3; ++k)
        group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0U);
      for (size_t k = 0; k < 4; ++k)
        text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
  };
  std::string objects, connections;
  const auto add_square = [&](int k, const std::string& layers) {
    const std::string id = std::to_string(k + 1);
    std::string places;
    for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      places += std::to_string(1.2 * k + x) + "," + std::to_string(y) + ",0,";
    places.pop_back();
    objects += "Geometry: 1" + id + ", \"Geometry::g\", \"Mesh\" {\nVertices: *12 {\na: " + places +
               "\n}\nPolygonVertexIndex: *4 {\na: 0,1,2,-4\n}\nGeometryVersion: 124\n" + layers +
               "LayerElementMaterial: 0 {\nMappingInformationType: \"AllSame\"\n"
               "ReferenceInformationType: \"IndexToDirect\"\nMaterials: *1 {\na: 0\n}\n}\n"
               "LayerElementUV: 0 {\nMappingInformationType: \"ByPolygonVertex\"\n"
               "ReferenceInformationType: \"Direct\"\nUV: *8 {\na: 0,0,1,0,1,1,0,1\n}\n}\n"
               "Layer: 0 {\nLayerElement: {\nType: \"LayerElementMaterial\"\nTypedIndex: 0\n}\n"
               "LayerElement: {\nType: \"LayerElementUV\"\nTypedIndex: 0\n}\n"
               "LayerElement: {\nType: \"LayerElementColor\"\nTypedIndex: 0\n}\n}\n}\n"
               "Model: 2" +
               id +
               ", \"Model::m\", \"Mesh\" {\n}\n"
               "Material: 3" +
               id +
               ", \"Material::c\", \"\" {\nShadingModel: \"lambert\"\n"
               "Properties70: {\nP: \"DiffuseColor\", \"Color\", \"\", \"A\",0,1,0\n}\n}\n";
    connections += "C: \"OO\",2" + id + ",0\nC: \"OO\",1" + id + ",2" + id + "\nC: \"OO\",3" + id +
                   ",2" + id + "\n";
  };
  const auto add_texture = [&](int k, const std::string& name, const std::string& content) {
    const std::string id = std::to_string(k + 1);
    objects += "Texture: 4" + id +
               ", \"Texture::t\", \"\" {\nType: \"TextureVideoClip\"\n"
               "RelativeFilename: \"" +
               name + "\"\nFileName: \"" + name +
               "\"\n}\n"
               "Video: 5" +
               id +
               ", \"Video::v\", \"Clip\" {\nType: \"Clip\"\n"
               "RelativeFilename: \"" +
               name + "\"\nFilename: \"" + name + "\"\n" + content + "}\n";
    connections +=
        "C: \"OP\",4" + id + ",3" + id + ", \"DiffuseColor\"\nC: \"OO\",5" + id + ",4" + id + "\n";
  };
  const std::string colours =
      "LayerElementColor: 0 {\nMappingInformationType: \"ByPolygonVertex\"\n"
      "ReferenceInformationType: \"Direct\"\nColors: *16 {\n"
      "a: 1,0.5,0,1,1,0.5,0,1,1,0.5,0,1,1,0.5,0,1\n}\n}\n";
  add_square(0, "");
  add_texture(0, "a.png", "Content: ,\n\"" + base64(image) + "\"\n");
  add_square(1, colours);
  add_square(2, "");
  add_texture(2, "beside.png", "");
  colour(folder_.write("a.fbx",
                       "; FBX 7.4.0 project file\nFBXHeaderExtension: {\nFBXVersion: 7400\n}\n"
                       "Objects: {\n" +
                           objects + "}\nConnections: {\n" + connections + "}\n"),
         kPerUnit);
  in_square(square(0),
            [&](double x, double y, const Point& p) { expect_light(p, bilinear(x, 1 - y)); });
  expect_square(1, {0, light(127.5), 0}, 0.5);
  expect_square(2, {0, 1, 0});
  EXPECT_THAT(report_.scene.unread_images,
              ElementsAre(HasSubstr("beside.png: this texture is not")));
}
#endif

}  // namespace
}  // namespace svdag
