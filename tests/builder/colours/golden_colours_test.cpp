// Scenes whose colour is known at every point (SVDAG_SCENES): wraps, coordinate sets, transforms,
// factors, colours of vertices and masks, by formulas of the glTF specification.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "io/scene/decoders/image.h"
#include "tests/builder/colours/coloured_scene.h"
#include "tests/shared_scenes.h"

namespace svdag {
namespace {

class GoldenColours : public ColouredScene {
 protected:
  void colour_shared(const std::string& name, int per_unit) {
    colour(shared_scene(name), per_unit);
    EXPECT_TRUE(report_.scene.unread_images.empty());
  }
};

TEST_F(GoldenColours, ColourChart) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour_shared("colour_chart.glb", 64);
  std::ifstream in(shared_scene("colour_chart_expected.json"));
  int tested = 0;
  const nlohmann::json expected = nlohmann::json::parse(in);
  for (const auto& point : expected["points"]) {
    const auto& p = point["point"];
    Point place(p[0], p[1], p[2]);
    if (point.value("hole", false)) {
      EXPECT_EQ(at(place + Point(0, 0, 0.001)), nullptr);
      continue;
    }
    const std::string node = point["node"];
    SCOPED_TRACE(point.dump());
    // The cube outside of a face of 64 x 64 texels holds one of them, and touches no other face.
    if (point.contains("normal")) {
      const auto& n = point["normal"];
      place += 0.001 * Point(n[0], n[1], n[2]);
    }
    const auto& c = point["srgb"];
    expect(place, light(c[0], c[1], c[2]), node == "sphere" ? 4 : 0.05);
    ++tested;
  }
  EXPECT_GT(tested, 90);
  int green = 0;
  in_square(Point(4, 0, 0.5), [&](double, double, const Point& centre) {
    const Light* const own = at(centre);
    if (own == nullptr) return;
    ++green;
    expect(centre, light(40, 160, 60), 0.05);  // no magenta
  });
  EXPECT_GT(green, 1000);
}

double wrapped_column(double u, int mode) {
  const double whole = std::floor(u), part = u - whole;
  if (mode == 0) return part;
  if (mode == 1) return std::fmod(std::abs(whole), 2) == 1 ? 1 - part : part;
  return std::min(std::max(u, 0.0), 0.999999);
}

Light texel(double u, double v) {
  return light(20 + 70 * std::floor(4 * u), 20 + 70 * std::floor(4 * v), 90);
}

TEST_F(GoldenColours, WrapModes) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour_shared("wrap_modes.glb", 60);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      in_square(Point(1.2 * column, -1.2 * row, 0), [&](double x, double y, const Point& centre) {
        const double u = wrapped_column(3 * x - 1, column);
        const double v = wrapped_column(3 * (1 - y) - 1, row);
        expect(centre, texel(u, v), 0.05);
      });
    }
  }
}

TEST_F(GoldenColours, CoordinateSetsTransformsFactorsAndColoursOfVertices) {
  SVDAG_NEEDS_SHARED_SCENES();
  colour_shared("texcoord1_transform.glb", 60);
  const auto square = [](int k) { return Point(1.2 * k, 0, 0); };
  const auto repeated = [](double u, double v) {
    return texel(u - std::floor(u), v - std::floor(v));
  };
  in_square(square(0), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x, 1 - y), 0.05);
  });
  // KHR_texture_transform: translation x rotation x scale; cubes within one texel.
  int tested = 0;
  in_square(square(1), [&](double x, double y, const Point& centre) {
    const double angle = M_PI / 6;
    std::map<std::pair<int, int>, Light> texels;
    for (const double dx : {-0.01, 0.01}) {
      for (const double dy : {-0.01, 0.01}) {
        const double s = 2 * (x + dx), t = 1.5 * (1 - y + dy);
        const double u = std::cos(angle) * s + std::sin(angle) * t + 0.25;
        const double v = std::cos(angle) * t - std::sin(angle) * s + 0.5;
        texels[{int(std::floor(4 * u)), int(std::floor(4 * v))}] = repeated(u, v);
      }
    }
    if (texels.size() > 1) return;
    ++tested;
    expect(centre, texels.begin()->second, 0.05);
  });
  EXPECT_GT(tested, 1500);
  in_square(square(2), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x + 0.25, 1 - y), 0.05);
  });
  for (int k = 3; k <= 5; ++k) {
    in_square(square(k), [&](double x, double y, const Point& centre) {
      // White, red, green and blue at the top left, bottom left, bottom right and top right.
      Light mix = x + y < 1 ? Light{y + (1 - x - y), y + x, y}
                            : Light{1 - x, (1 - x) + (1 - y), (1 - x) + (x + y - 1)};
      if (k == 3) {
        const Light image = repeated(x, 1 - y);
        const Light factor = {1, 0.5, 0.25};
        for (size_t c = 0; c < 3; ++c) mix[c] *= image[c] * factor[c];
      }
      expect(centre, mix, 1);
    });
  }
  in_square(square(6), [&](double x, double y, const Point& centre) {
    expect(centre, repeated(x, 1 - y), 0.05);
  });
}

// The quads of the Khronos sample, by the formula of KHR_texture_transform, where their images are
// plain.
TEST_F(GoldenColours, TextureTransformTest) {
  SVDAG_NEEDS_SHARED_SCENES();
  const std::string path = shared_scene("texture_transform_test.glb");
  colour(path, 100);
  std::ifstream in(path, std::ios::binary);
  const std::string glb{std::istreambuf_iterator<char>(in), {}};
  uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, &glb[12], sizeof json_bytes);
  const nlohmann::json json = nlohmann::json::parse(glb.substr(20, json_bytes));
  const auto view = [&](size_t i) {
    const auto& v = json["bufferViews"][i];
    return std::as_bytes(std::span(glb).subspan(28 + json_bytes + v.value("byteOffset", 0U),
                                                v["byteLength"].get<size_t>()));
  };
  MemoryBudget budget;
  for (const auto& node : json["nodes"]) {
    const std::string name = node["name"];
    if (name.find(" - ") != name.npos) continue;  // the marks
    SCOPED_TRACE(name);
    const auto& primitive = json["meshes"][node["mesh"].get<size_t>()]["primitives"][0];
    std::array<float, 8> uv;  // of the corners
    const auto& accessor = json["accessors"][primitive["attributes"]["TEXCOORD_0"].get<size_t>()];
    std::memcpy(uv.data(), view(accessor["bufferView"]).data(), sizeof uv);
    std::array<float, 12> corners;
    std::memcpy(corners.data(), view(0).data(), sizeof corners);
    const auto& texture = json["materials"][primitive["material"].get<size_t>()]
                              ["pbrMetallicRoughness"]["baseColorTexture"];
    const auto& transform = texture["extensions"]["KHR_texture_transform"];
    const auto pair = [&](const char* key, double fallback) {
      return transform.value(key, std::array<double, 2>{fallback, fallback});
    };
    const auto offset = pair("offset", 0), scale = pair("scale", 1);
    const double angle = transform.value("rotation", 0.0);
    const ColourTexels image = colours_of_image(
        {view(json["images"][texture["index"].get<size_t>()]["bufferView"]), path}, &budget);
    const auto texel = [&](int64_t i, int64_t j) {
      const int64_t column = std::clamp<int64_t>(i, 0, image.width - 1);
      const uint8_t* const rgba = &image.rgba[size_t(
          4 * (std::clamp<int64_t>(j, 0, image.height - 1) * image.width + column))];
      return std::array<uint8_t, 3>{rgba[0], rgba[1], rgba[2]};
    };
    // Coordinates are linear in x and y: of the corner at the low end, and by the others.
    const auto coordinate = [&](double x, double y) {
      std::array<double, 2> at{};
      for (size_t k = 0; k < 4; ++k) {
        const double share =
            (corners[3 * k] > 0 ? x : 1 - x) * (corners[3 * k + 1] > 0 ? y : 1 - y);
        for (size_t c = 0; c < 2; ++c) at[c] += share * uv[2 * k + c];
      }
      return at;
    };
    const auto& t = node["translation"];
    const Point low(t[0].get<double>() - 0.5, t[1].get<double>() - 0.5, 0);
    std::set<std::array<uint8_t, 3>> seen;
    const int n = 100;
    for (int i = 2; i + 2 < n; ++i) {
      for (int j = 2; j + 2 < n; ++j) {
        const Point p = low + Point((i + 0.5) / n, (j + 0.5) / n, -0.5 / n);
        const auto at = coordinate(p.x - low.x, p.y - low.y);
        const double s = scale[0] * at[0], r = scale[1] * at[1];
        const double u = image.width * (std::cos(angle) * s + std::sin(angle) * r + offset[0]);
        const double v = image.height * (std::cos(angle) * r - std::sin(angle) * s + offset[1]);
        const auto middle = texel(int64_t(std::floor(u)), int64_t(std::floor(v)));
        bool is_plain = true;
        for (int a = -4; a <= 4; ++a) {
          for (int b = -4; b <= 4; ++b)
            is_plain &= texel(int64_t(std::floor(u)) + a, int64_t(std::floor(v)) + b) == middle;
        }
        if (!is_plain) continue;
        expect(p, light(middle[0], middle[1], middle[2]), 0.05);
        seen.insert(middle);
      }
    }
    EXPECT_GT(seen.size(), 1U);
  }
}

}  // namespace
}  // namespace svdag
