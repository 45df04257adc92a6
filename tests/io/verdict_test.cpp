#include "io/verdict.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(Verdict, PrintsEveryFigureAsTextAndAsJson) {
  Verdict verdict;
  verdict.for_programs("command", "mesh");
  verdict.add("bricks", "bricks", 1234567u, "(all)");
  verdict.also("wrong_bricks", 0, "wrong");
  verdict.add("distance", "far", rounded(0.25, "%.4f"), "voxels");
  verdict.add("ok", "", shown(true, "ok: every voxel agrees"));
  EXPECT_EQ(verdict.text(),
            "bricks  1,234,567 (all), 0 wrong\n"
            "far     0.2500 voxels\n"
            "ok: every voxel agrees\n");
  EXPECT_EQ(verdict.json(),
            R"({"command":"mesh","bricks":1234567,"wrong_bricks":0,"distance":0.25,"ok":true})");
}

TEST(Verdict, KeysNameMembersOfObjectsAndLists) {
  Verdict verdict;
  for (const char* layer : {"a", "b"}) {
    const std::string key = *layer == 'a' ? "layers/0/" : "layers/1/";
    verdict.add(key + "name", "layer", layer);
    verdict.also(key + "voxels", -1, "voxels");
  }
  verdict.for_programs("sample/draws", std::array{1, 2});
  EXPECT_EQ(verdict.text(), "layer  a, -1 voxels\nlayer  b, -1 voxels\n");
  EXPECT_EQ(verdict.json(), R"({"layers":[{"name":"a","voxels":-1},{"name":"b","voxels":-1}],)"
                            R"("sample":{"draws":[1,2]}})");
  EXPECT_EQ(verdict.json(1).substr(0, 16), "{\n \"layers\": [\n ");
}

TEST(Verdict, AListOfTextsGetsALineForEach) {
  Verdict verdict;
  verdict.add("defects", "defect", std::vector<std::string>{"one", "two\n"});
  verdict.add("unmatched", "unmatched", std::vector<std::string>());
  verdict.add("nodes", "nodes", std::vector<uint64_t>{1, 1000}, "on 2 levels");
  EXPECT_EQ(verdict.text(), "defect  one\ndefect  two?\nnodes   1, 1,000 on 2 levels\n");
  EXPECT_EQ(verdict.json(), R"({"defects":["one","two\n"],"unmatched":[],"nodes":[1,1000]})");
}

TEST(Verdict, OtherValues) {
  Verdict verdict;
  verdict.for_programs("none", nullptr);
  verdict.for_programs("not_a_number", 0.0 / 0.0);
  verdict.for_programs("name", "\xff\"");
  verdict.for_programs("largest", UINT64_MAX);
  EXPECT_EQ(verdict.json(),
            "{\"none\":null,\"not_a_number\":null,\"name\":\"\xEF\xBF\xBD\\\"\","
            "\"largest\":18446744073709551615}");
  EXPECT_EQ(verdict.text(), "");
}

TEST(Verdict, HiddenFiguresAreInTheJson) {
  Verdict verdict;
  verdict.add("a", "a", 1);
  verdict.hide(true);
  verdict.add("b", "b", 2);
  verdict.also("c", 3);
  verdict.hide(false);
  verdict.also("d", 4);
  EXPECT_EQ(verdict.text(), "a  1, 4\n");
  EXPECT_EQ(verdict.json(), R"({"a":1,"b":2,"c":3,"d":4})");
}

}  // namespace
}  // namespace svdag
