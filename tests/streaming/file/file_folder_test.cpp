#include "streaming/file/file_folder.h"

#include <sys/fsuid.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

mode_t mode_of(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(lstat(path.c_str(), &status), 0);
  return status.st_mode & 07777;
}

// As on a file server that maps root to another user.
TEST(PrivateFolder, IsOursIfWeMadeItWhoeverItSeemsToBelongTo) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make a folder that is another user's";
  const TempFolder temp;
  ASSERT_EQ(chmod(temp.path().c_str(), 0777), 0);
  setfsuid(12345);
  EXPECT_NO_THROW(EXPECT_TRUE(Folder::open_private(temp.file("s")).made()));
  setfsuid(0);
  struct stat status {};
  ASSERT_EQ(lstat(temp.file("s").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 12345U);
  EXPECT_SVDAG_ERROR(Folder::open_private(temp.file("s")), ExitCode::kOutput,
                     "s: belongs to another user");
  setfsuid(12345);
  EXPECT_NO_THROW(EXPECT_FALSE(Folder::open_private(temp.file("s")).made()));  // resumed
  EXPECT_TRUE(Folder::open_private(temp.file("s")).names().empty());
  setfsuid(0);
}

TEST(SharedFolder, IsMadeForThisUserAlone) {
  const TempFolder temp;
  const Folder folder = Folder::open_shared(temp.file("s"));
  EXPECT_TRUE(folder.made());
  EXPECT_EQ(mode_of(temp.file("s")), 0700U);
}

TEST(SharedFolder, KeepsTheModeThatItHas) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  for (const mode_t mode : {0700U, 0750U, 0755U, 02775U}) {
    ASSERT_EQ(chmod(temp.file("s").c_str(), mode), 0);
    const Folder folder = Folder::open_shared(temp.file("s"));
    EXPECT_FALSE(folder.made());
    folder.create("a");
    folder.remove("a");
    EXPECT_EQ(mode_of(temp.file("s")), mode);
  }
}

TEST(SharedFolder, IsRefusedAndLeftAsItIsWhereEverybodyMayWrite) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  for (const mode_t mode : {0777U, 01777U}) {
    ASSERT_EQ(chmod(temp.file("s").c_str(), mode), 0);
    EXPECT_SVDAG_ERROR(Folder::open_shared(temp.file("s")), ExitCode::kUsage,
                       "s: this folder is world-writable");
    EXPECT_EQ(mode_of(temp.file("s")), mode);
  }
}

TEST(SharedFolder, IsNoLink) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  fs::create_directory_symlink(temp.file("s"), temp.file("link"));
  EXPECT_SVDAG_ERROR(Folder::open_shared(temp.file("link")), ExitCode::kOutput, "is a link");
}

}  // namespace
}  // namespace svdag
