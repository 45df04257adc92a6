#include "streaming/file/command_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

void expect_input(CommandFiles files, const std::string& output) {
  EXPECT_SVDAG_ERROR(files.write(output), ExitCode::kUsage, "is also an input");
}

TEST(CommandFiles, AnInputIsFoundByAnyPath) {
  const TempFolder folder;
  const std::string a = folder.write("a", "A"), b = folder.write("b", "A");
  std::filesystem::create_symlink(a, folder.file("link"));
  CommandFiles files({a});
  expect_input(files, folder.path() + "/./a");
  expect_input(files, folder.file("link"));
  files.write(b);
}

TEST(CommandFiles, AnInputThatDoesNotExistIsFoundByItsDirectoryEntry) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  std::filesystem::create_directory_symlink(folder.file("in"), folder.file("link"));
  CommandFiles files({folder.file("in/new"), folder.file("none/a")});
  expect_input(files, folder.file("in/../in/new"));
  expect_input(files, folder.file("link/new"));
  expect_input(files, folder.file("none/a"));
  files.write(folder.file("new"));
  files.write(folder.file("in/other"));
  files.write(folder.file("none/b"));
}

TEST(CommandFiles, AFileIsReadOnce) {
  const TempFolder folder;
  const std::string a = folder.write("a", "A");
  std::filesystem::create_symlink(a, folder.file("link"));
  CommandFiles files;
  EXPECT_TRUE(files.read(a));
  EXPECT_FALSE(files.read(a));
  EXPECT_FALSE(files.read(folder.file("link")));
  EXPECT_TRUE(files.read(folder.write("b", "A")));
}

// A rename replaces a hard link, and goes through a symbolic one.
TEST(CommandFiles, OnlyHardLinksToOneFileAreDifferentOutputs) {
  const TempFolder folder;
  const std::string a = folder.write("a", "A");
  std::filesystem::create_hard_link(a, folder.file("b"));
  std::filesystem::create_symlink(a, folder.file("c"));
  CommandFiles files;
  for (const char* name : {"a", "b"}) files.write(folder.file(name));
  for (const char* name : {"./a", "c"})
    EXPECT_SVDAG_ERROR(files.write(folder.file(name)), ExitCode::kUsage, "would be written twice");
}

}  // namespace
}  // namespace svdag
