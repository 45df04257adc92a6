// The tree built from events against nlohmann-json's own, which keeps everything.
#include "io/scene/gltf/document/gltf_json.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "streaming/error.h"
#include "tests/memory_file.h"

namespace svdag {
namespace {

using nlohmann::json;
using Random = std::mt19937_64;

std::string random_text(Random& random, int depth);

std::string random_key(Random& random) {
  static constexpr std::array<const char*, 8> kKeys = {"nodes",  "meshes",     "asset", "images",
                                                       "extras", "animations", "a",     ""};
  return kKeys[random() % kKeys.size()];
}

// Text rather than a value, so that names may come twice.
std::string random_members(Random& random, int depth, bool object) {
  std::string text(1, object ? '{' : '[');
  for (uint64_t left = random() % 5; left > 0; --left) {
    if (object) text += '"' + random_key(random) + "\": ";
    text += random_text(random, depth + 1) + (left > 1 ? ", " : " ");
  }
  return text + (object ? '}' : ']');
}

std::string random_text(Random& random, int depth) {
  static constexpr std::array<const char*, 9> kScalars = {
      "null", "true", "false", "-3", "17", "1.5e3", "\"text\"", "\"\\u00e9 \\\"\"", "1e999"};
  if (depth < 6 && random() % 2 == 0) return random_members(random, depth, random() % 2 == 0);
  return kScalars[random() % (random() % 500 == 0 ? 9 : 8)];
}

json parse(const std::string& text) {
  const MemoryFile memory(text);
  MemoryBudget budget;
  MemoryBudget::Reservation reservation = budget.reserve(0, "test");
  return parse_gltf_json(memory.file(), 0, text.size(), {}, &reservation);
}

// Without the members of the root that do not concern geometry.
json expected(const std::string& text) {
  static const std::set<std::string> kKept = {"asset",       "scene",   "scenes",
                                              "nodes",       "meshes",  "accessors",
                                              "bufferViews", "buffers", "extensionsRequired"};
  json tree = json::parse(text);
  if (!tree.is_object()) return tree;
  json kept = json::object();
  for (const auto& [key, value] : tree.items()) {
    if (kKept.contains(key)) kept[key] = value;
  }
  return kept;
}

TEST(GltfJson, IsTheWholeTreeWithoutWhatSaysNothingAboutGeometry) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const std::string text = random_members(random, 0, random() % 8 != 0);
    json tree;
    try {
      tree = expected(text);
    } catch (const json::out_of_range&) {
      EXPECT_THROW(parse(text), Error) << text;
      continue;
    }
    ASSERT_EQ(parse(text), tree) << text;
  }
}

TEST(GltfJson, BrokenTextIsRefusedAtTheSamePlace) {
  Random random(6);
  int broken = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = random_members(random, 0, true);
    text[random() % text.size()] = "{}[],:\"x1 "[random() % 10];
    try {
      expected(text);
    } catch (const json::parse_error& error) {
      ++broken;
      const std::string place = std::to_string(error.byte);
      try {
        parse(text);
        ADD_FAILURE() << "was read: " << text;
      } catch (const Error& refusal) {
        EXPECT_NE(std::string(refusal.what()).find(place), std::string::npos) << refusal.what();
      }
    } catch (const json::exception&) {
    }
  }
  EXPECT_GT(broken, 1000);
}

TEST(GltfJson, NestingIsBoundedInWhatIsSkippedToo) {
  for (const char* key : {"nodes", "extras"}) {
    const auto nested = [&](size_t levels) {
      const std::string head = std::string("{\"") + key + "\": ";
      return head + std::string(levels, '[') + "1" + std::string(levels, ']') + "}";
    };
    EXPECT_NO_THROW(parse(nested(255))) << key;
    EXPECT_THROW(parse(nested(256)), Error) << key;
    EXPECT_THROW(parse(nested(100000)), Error) << key;
  }
}

}  // namespace
}  // namespace svdag
