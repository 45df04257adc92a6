#include "streaming/file/file_names.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/temp_folder.h"

namespace svdag {
namespace {

TEST(FileNames, AFileIsFoundByAnyPath) {
  const TempFolder folder;
  const std::string a = folder.write("a", "A"), b = folder.write("b", "A");
  std::filesystem::create_symlink(a, folder.file("link"));
  FileNames names;
  names.add(a);
  ASSERT_NE(names.find(folder.path() + "/./a"), nullptr);
  EXPECT_EQ(*names.find(folder.path() + "/./a"), a);
  EXPECT_NE(names.find(folder.file("link")), nullptr);
  EXPECT_EQ(names.find(b), nullptr);
}

TEST(FileNames, AFileThatDoesNotExistIsFoundByItsDirectoryEntry) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  std::filesystem::create_directory_symlink(folder.file("in"), folder.file("link"));
  FileNames names;
  names.add(folder.file("in/new"));
  EXPECT_NE(names.find(folder.file("in/../in/new")), nullptr);
  EXPECT_NE(names.find(folder.file("link/new")), nullptr);
  EXPECT_EQ(names.find(folder.file("new")), nullptr);
  EXPECT_EQ(names.find(folder.file("in/other")), nullptr);
}

TEST(FileNames, LinksToOneFileHaveDifferentDirectoryEntries) {
  const TempFolder folder;
  const std::string a = folder.write("a", "A");
  std::filesystem::create_hard_link(a, folder.file("b"));
  std::filesystem::create_symlink(a, folder.file("c"));
  EXPECT_EQ(directory_entry_key(folder.path() + "/./a"), directory_entry_key(a));
  EXPECT_NE(directory_entry_key(folder.file("b")), directory_entry_key(a));
  EXPECT_NE(directory_entry_key(folder.file("c")), directory_entry_key(a));
}

TEST(FileNames, AFileInAFolderThatDoesNotExistIsFoundByItsPathAlone) {
  const TempFolder folder;
  FileNames names;
  names.add(folder.file("none/a"));
  EXPECT_NE(names.find(folder.file("none/a")), nullptr);
  EXPECT_EQ(names.find(folder.file("none/b")), nullptr);
}

}  // namespace
}  // namespace svdag
