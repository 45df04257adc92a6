// has_ending() ignores case.
#include "streaming/file/file_ending.h"

#include <gtest/gtest.h>

namespace svdag {
namespace {

TEST(FileEnding, IgnoresCase) {
  for (const char* name : {"a.png", "A.PNG", "a.b.Png", ".png"})
    EXPECT_TRUE(has_ending(name, ".png")) << name;
  for (const char* name : {"", "png", "a.png ", "a.pn", "a.png.gz", "apng"})
    EXPECT_FALSE(has_ending(name, ".png")) << name;
}

}  // namespace
}  // namespace svdag
