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

// As on a file server that maps root to another user: the folder we created belongs to that user,
// and so do our new files.
TEST(PrivateFolder, IsAcceptedIfNewFilesHaveItsOwner) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can create a folder of another user";
  const TempFolder temp;
  ASSERT_EQ(chmod(temp.path().c_str(), 0777), 0);
  setfsuid(12345);
  EXPECT_NO_THROW(EXPECT_TRUE(Folder::open_private(temp.file("s")).created()));
  setfsuid(0);
  struct stat status {};
  ASSERT_EQ(lstat(temp.file("s").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 12345U);
  EXPECT_SVDAG_ERROR(Folder::open_private(temp.file("s")), ExitCode::kOutput,
                     "s: belongs to another user");
  setfsuid(12345);
  EXPECT_NO_THROW(EXPECT_FALSE(Folder::open_private(temp.file("s")).created()));  // resumed
  EXPECT_TRUE(Folder::open_private(temp.file("s")).names().empty());
  setfsuid(0);
}

TEST(SharedFolder, IsCreatedForThisUserAlone) {
  const TempFolder temp;
  const Folder folder = Folder::open_shared(temp.file("s"));
  EXPECT_TRUE(folder.created());
  EXPECT_EQ(mode_of(temp.file("s")), 0700U);
}

TEST(SharedFolder, KeepsItsMode) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  for (const mode_t mode : {0700U, 0750U, 0755U, 02775U}) {
    ASSERT_EQ(chmod(temp.file("s").c_str(), mode), 0);
    const Folder folder = Folder::open_shared(temp.file("s"));
    EXPECT_FALSE(folder.created());
    folder.create("a");
    folder.remove("a");
    EXPECT_EQ(mode_of(temp.file("s")), mode);
  }
}

TEST(SharedFolder, IsRejectedUnchangedIfWorldWritable) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  for (const mode_t mode : {0777U, 01777U}) {
    ASSERT_EQ(chmod(temp.file("s").c_str(), mode), 0);
    EXPECT_SVDAG_ERROR(Folder::open_shared(temp.file("s")), ExitCode::kUsage,
                       "s: this folder is world-writable");
    EXPECT_EQ(mode_of(temp.file("s")), mode);
  }
}

TEST(SharedFolder, MustNotBeALink) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  fs::create_directory_symlink(temp.file("s"), temp.file("link"));
  EXPECT_SVDAG_ERROR(Folder::open_shared(temp.file("link")), ExitCode::kOutput, "is a link");
}

}  // namespace
}  // namespace svdag
