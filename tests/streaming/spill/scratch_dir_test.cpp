#include "streaming/spill/scratch_dir.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <set>
#include <thread>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

namespace fs = std::filesystem;

std::string text_of(const File& file) {
  std::string text(file.size(), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(text)));
  return text;
}

pid_t start(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  return child;
}

int status_of(pid_t child) {
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

TEST(ScratchDir, IsBesideTheOutputOrNamedAfterItsAbsolutePath) {
  EXPECT_EQ(ScratchDir::path_for("a/out.svdag", ""), "a/out.svdag.scratch");
  const std::string here = ScratchDir::path_for("out.svdag", "/big");
  EXPECT_EQ(here.substr(0, 15), "/big/out.svdag-");
  EXPECT_EQ(here.substr(31), ".scratch");
  EXPECT_EQ(ScratchDir::path_for(fs::current_path() / "x/../out.svdag", "/big"), here);
  EXPECT_NE(ScratchDir::path_for("x/out.svdag", "/big"), here);
}

TEST(ScratchDir, ALongNameIsShortenedBetweenTwoCharactersAndStaysUnique) {
  const auto name_of = [](const std::string& path) { return fs::path(path).filename().string(); };
  const TempFolder temp;
  for (const std::string& under : {std::string(), temp.file("under")}) {
    std::set<std::string> paths;
    for (const size_t length : {247, 248, 250, 254, 255}) {
      const std::string path = ScratchDir::path_for(temp.file(std::string(length, 'n')), under);
      EXPECT_EQ(fs::path(path).parent_path(), under.empty() ? temp.path() : under);
      EXPECT_LE(name_of(path).size(), 255U);
      EXPECT_TRUE(paths.insert(path).second);
    }
    std::string wide;  // two bytes a character
    while (wide.size() < 254) wide += "\u00e4";
    const std::string cut = name_of(ScratchDir::path_for(temp.file(wide), under));
    EXPECT_EQ(cut.find('-') % 2, 0U);
    EXPECT_EQ(name_of(ScratchDir::path_for(temp.file("n" + wide), under)).find('-') % 2, 1U);
  }
  EXPECT_EQ(name_of(ScratchDir::path_for(std::string(247, 'n'), "")),
            std::string(247, 'n') + ".scratch");
  ScratchDir made(ScratchDir::path_for(temp.file(std::string(250, 'n')), ""));
}

TEST(ScratchDir, AnOutputReachedThroughALinkHasTheSameFolder) {
  const TempFolder temp;
  fs::create_directory(temp.file("real"));
  fs::create_directory_symlink(temp.file("real"), temp.file("link"));
  EXPECT_EQ(ScratchDir::path_for(temp.file("link/out"), "/big"),
            ScratchDir::path_for(temp.file("real/out"), "/big"));
}

TEST(ScratchDir, FolderAndFilesAreForThisUserOnlyWithAnyUmask) {
  const TempFolder temp;
  const mode_t before = umask(0);
  ScratchDir dir(temp.file("s"));
  const File file = dir.create("spill");
  umask(before);
  EXPECT_EQ(mode_of(temp.file("s")), 0700U);
  EXPECT_EQ(mode_of(temp.file("s/owner")), 0600U);
  EXPECT_EQ(mode_of(temp.file("s/spill")), 0600U);
}

TEST(ScratchDir, ClosesAnExistingFolderToOtherUsers) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  fs::permissions(temp.file("s"), fs::perms::all);
  const ScratchDir dir(temp.file("s"));
  EXPECT_EQ(mode_of(temp.file("s")), 0700U);
}

TEST(ScratchDir, FilesAreCreatedOpenedAndRemoved) {
  const TempFolder temp;
  ScratchDir dir(temp.file("s"));
  EXPECT_FALSE(dir.has("a"));
  EXPECT_SVDAG_ERROR(dir.open("a"), ExitCode::kOutput, "s/a: cannot be opened: no such file");
  dir.create("a").write_at(0, bytes_of("first"));
  EXPECT_TRUE(dir.has("a"));
  EXPECT_EQ(text_of(dir.open("a")), "first");
  dir.open("a").write_at(0, bytes_of("F"));
  EXPECT_EQ(text_of(dir.open("a")), "First");
  EXPECT_EQ(text_of(dir.create("a")), "");
  dir.create("b");
  dir.sync();
  dir.remove("a");
  dir.remove("a");
  EXPECT_FALSE(dir.has("a"));
  dir.clear();
  EXPECT_FALSE(dir.has("b"));
  EXPECT_TRUE(dir.has("owner"));
  EXPECT_GT(dir.free_bytes(), 0U);
}

TEST(ScratchDir, IsRemovedAtTheEndUnlessItIsKept) {
  const TempFolder temp;
  { ScratchDir(temp.file("s")).create("spill"); }
  EXPECT_EQ(temp.entries(), 0U);
  {
    ScratchDir dir(temp.file("s"));
    dir.create("spill").write_at(0, bytes_of("kept"));
    dir.keep();
  }
  {
    ScratchDir dir(temp.file("s"));
    EXPECT_EQ(text_of(dir.open("spill")), "kept");
  }
  EXPECT_EQ(temp.entries(), 0U);
}

TEST(ScratchDir, AForeignSubfolderRemainsButNoFile) {
  const TempFolder temp;
  {
    ScratchDir dir(temp.file("s"));
    dir.create("spill");
    fs::create_directory(temp.file("s/a"));
  }
  EXPECT_TRUE(fs::exists(temp.file("s/a")));
  EXPECT_FALSE(fs::exists(temp.file("s/spill")));
}

TEST(ScratchDir, TheNextOwnerTakesOverFilesThatCouldNotBeRemoved) {
  const TempFolder temp;
  {
    ScratchDir dir(temp.file("s"));
    dir.create("spill");
    dir.create("other");
    fs::remove(temp.file("s/spill"));
    fs::create_directory(temp.file("s/spill"));  // cannot be removed as a file
  }
  EXPECT_TRUE(fs::exists(temp.file("s/owner")));
  EXPECT_FALSE(fs::exists(temp.file("s/other")));
  { ScratchDir dir(temp.file("s")); }
  EXPECT_TRUE(fs::exists(temp.file("s/owner")));
  fs::remove(temp.file("s/spill"));
  { ScratchDir dir(temp.file("s")); }
  EXPECT_EQ(temp.entries(), 0U);
}

TEST(ScratchDir, AFolderWithForeignFilesIsRejectedUnchanged) {
  const TempFolder folder;
  const std::string path = folder.file("s");
  std::filesystem::create_directory(path);
  folder.write("s/thesis.txt", "years");
  folder.write("s/probe-7.csv", "precious");
  EXPECT_SVDAG_ERROR(ScratchDir{path}, ExitCode::kOutput, "is not a scratch folder");
  EXPECT_EQ(folder.read("s/thesis.txt"), "years");
}

// The remains of a process that was killed while it tested the owner of new files.
TEST(ScratchDir, AProbeOfFileOwnershipIsNotAForeignFile) {
  const TempFolder folder;
  const std::string path = folder.file("s");
  std::filesystem::create_directory(path);
  folder.write("s/.svdag-0123456789abcdef.tmp", "");
  { ScratchDir dir(path); }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(ScratchDir, RejectsALinkOrAFile) {
  const TempFolder temp;
  fs::create_directory(temp.file("elsewhere"));
  fs::create_directory_symlink(temp.file("elsewhere"), temp.file("link"));
  fs::create_symlink(temp.file("nowhere"), temp.file("dangling"));
  temp.write("file", "");
  for (const char* name : {"link", "link/", "dangling", "file"}) {
    EXPECT_SVDAG_ERROR(ScratchDir(temp.file(name)), ExitCode::kOutput, "is a link or a file");
  }
  EXPECT_TRUE(fs::is_empty(temp.file("elsewhere")));
  EXPECT_FALSE(fs::exists(temp.file("nowhere")));
  EXPECT_SVDAG_ERROR(ScratchDir(temp.file("no/s")), ExitCode::kOutput,
                     "no: cannot write in this folder: no such file or folder");
}

TEST(ScratchDir, RejectsAnotherUsersFolder) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  ASSERT_EQ(chown(temp.file("s").c_str(), 12345, 12345), 0);
  EXPECT_SVDAG_ERROR(ScratchDir(temp.file("s")), ExitCode::kOutput, "belongs to another user");
}

TEST(ScratchDir, PlantedFilesAreNeitherFollowedNorWrittenTo) {
  const TempFolder temp;
  temp.write("precious", "keep");
  fs::create_directory(temp.file("s"));
  temp.write("s/owner", "");
  fs::create_symlink(temp.file("precious"), temp.file("s/link"));
  fs::create_hard_link(temp.file("precious"), temp.file("s/second"));
  ASSERT_EQ(mkfifo(temp.file("s/pipe").c_str(), 0600), 0);
  {
    ScratchDir dir(temp.file("s"));
    EXPECT_FALSE(dir.has("link"));
    for (const char* name : {"link", "second", "pipe"})
      EXPECT_SVDAG_ERROR(dir.open(name), ExitCode::kOutput,
                         "is not a regular file, or has other hard links");
    for (const char* name : {"link", "second", "pipe"})
      dir.create(name).write_at(0, bytes_of("spill"));
  }
  EXPECT_EQ(temp.read("precious"), "keep");
  EXPECT_FALSE(fs::exists(temp.file("s")));

  fs::create_directory(temp.file("s"));
  fs::create_symlink(temp.file("precious"), temp.file("s/owner"));
  EXPECT_SVDAG_ERROR(ScratchDir(temp.file("s")), ExitCode::kOutput,
                     "s/owner: is not a regular file, or has other hard links");
}

TEST(ScratchDir, ASecondOwnerIsRejectedAndChangesNothing) {
  const TempFolder temp;
  ScratchDir dir(temp.file("s"));
  dir.create("spill").write_at(0, bytes_of("mine"));
  const pid_t child = start([&] {
    try {
      ScratchDir other(temp.file("s"));
      return 1;
    } catch (const Error& error) {
      const std::string what = error.what();
      const bool expected = error.code() == ExitCode::kUsage &&
                            what.find("another bake is using this scratch folder") != what.npos;
      return expected ? 0 : 2;
    }
  });
  EXPECT_EQ(status_of(child), 0);
  EXPECT_SVDAG_ERROR(ScratchDir(temp.file("s")), ExitCode::kUsage, "another bake is using");
  EXPECT_EQ(text_of(dir.open("spill")), "mine");
}

TEST(ScratchDir, IsInUseWhileItHasAnOwner) {
  const TempFolder temp;
  const std::string path = temp.file("s");
  EXPECT_FALSE(ScratchDir::in_use(path));
  {
    ScratchDir dir(path);
    EXPECT_TRUE(ScratchDir::in_use(path));
    dir.keep();
  }
  EXPECT_FALSE(ScratchDir::in_use(path));
  ScratchDir again(path);  // the test has not changed the folder
}

// in_use() takes a shared lock for a moment.
TEST(ScratchDir, ASharedLockIsNotAnOwner) {
  const TempFolder temp;
  fs::create_directory(temp.file("s"));
  const int fd = open(temp.write("s/owner", "").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(fd, LOCK_SH), 0);
  EXPECT_FALSE(ScratchDir::in_use(temp.file("s")));
  close(fd);
}

TEST(ScratchDir, TheFolderOfAKilledOwnerIsTakenOverWithItsFiles) {
  const TempFolder temp;
  const pid_t child = start([&] {
    ScratchDir dir(temp.file("s"));
    dir.create("journal").write_at(0, bytes_of("half"));
    raise(SIGKILL);
    return 0;
  });
  EXPECT_TRUE(WIFSIGNALED(status_of(child)));
  ScratchDir dir(temp.file("s"));
  EXPECT_EQ(text_of(dir.open("journal")), "half");
}

// Each owner creates the file `witness` with O_EXCL and removes it before it releases the folder:
// two owners at the same time would collide there.
int own_many_times(const std::string& path, const std::string& witness) {
  for (int owned = 0; owned < 30;) {
    try {
      const ScratchDir dir(path);
      const int fd = open(witness.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
      if (fd < 0) return 1;
      close(fd);
      std::this_thread::yield();  // lets a second owner run, if there is one by mistake
      if (!dir.has("owner") || unlink(witness.c_str()) != 0) return 2;
      ++owned;
    } catch (const Error& error) {
      if (error.code() != ExitCode::kUsage) return 3;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }
  return 0;
}

TEST(ScratchDir, SixteenProcessesNeverShareIt) {
  const TempFolder temp;
  std::vector<pid_t> children;
  for (int i = 0; i < 16; ++i) {
    children.push_back(start([&] { return own_many_times(temp.file("s"), temp.file("witness")); }));
  }
  for (const pid_t child : children) EXPECT_EQ(status_of(child), 0);
}

}  // namespace
}  // namespace svdag
