// A scene of a format that is not read is recognised by its name or by its first bytes.
#include "io/scene/scene_formats.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(ForeignFormats, AreRecognisedByName) {
  EXPECT_EQ(foreign_format_message("blend", ""),
            "is Blender, which svdag does not read: open it in Blender and export it as .glb");
  for (const char* extension :
       {"abc", "usd", "usda", "usdc", "usdz", "step", "laz", "zst", "splat", "npz"})
    EXPECT_NE(foreign_format_message(extension, "anything"), "") << extension;
}

TEST(ForeignFormats, AreRecognisedByTheirFirstBytes) {
  EXPECT_NE(foreign_format_message("", "BLENDER-"), "");
  EXPECT_NE(foreign_format_message("model", "#usda 1."), "");
  EXPECT_NE(foreign_format_message("", std::string_view("PK\x03\x04zzzz", 8)).find("ZIP"),
            std::string::npos);
}

TEST(ForeignFormats, OthersHaveNoMessage) {
  for (const char* extension : {"", "ply", "txt", "a", "s"})
    EXPECT_EQ(foreign_format_message(extension, "hello, t"), "") << extension;
  EXPECT_EQ(foreign_format_message("", ""), "");
  EXPECT_EQ(foreign_format_message("", "P"), "");
}

}  // namespace
}  // namespace svdag
