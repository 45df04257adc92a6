#include "streaming/file/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

TEST(AtomicFile, NothingIsLeftBehindWithoutCommit) {
  const TempFolder folder;
  { AtomicFile(folder.file("out")).append("half of it"); }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(AtomicFile, TheOldFileStaysUntilCommit) {
  const TempFolder folder;
  folder.write("out", "old");
  AtomicFile file(folder.file("out"));
  file.append("new");
  EXPECT_EQ(folder.read("out"), "old");
  file.commit();
  EXPECT_EQ(folder.read("out"), "new");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFile, AnUncommittedFileLeavesTheOldOneUnchanged) {
  const TempFolder folder;
  folder.write("out", "old");
  { AtomicFile(folder.file("out")).append("new"); }
  EXPECT_EQ(folder.read("out"), "old");
}

TEST(AtomicFile, AReaderOfTheOldFileKeepsReadingIt) {
  const TempFolder folder;
  const File reader = File::open_read(folder.write("out", "old"));
  AtomicFile file(folder.file("out"));
  file.append("new");
  file.commit();
  std::string text(3, '\0');
  reader.read_at(0, std::as_writable_bytes(std::span(text)));
  EXPECT_EQ(text, "old");
}

TEST(AtomicFile, PermissionsFollowTheUmask) {
  const TempFolder folder;
  const mode_t before = umask(027);
  AtomicFile file(folder.file("out"));
  file.commit();
  umask(before);
  EXPECT_EQ(mode_of(folder.file("out")), 0640U);
}

// commit() must not change the umask, even for a moment: another thread may create files.
TEST(AtomicFile, CommitDoesNotChangeTheUmaskOfOtherThreads) {
  const TempFolder folder;
  const mode_t before = umask(027);
  {
    const std::jthread other([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) AtomicFile(folder.file("out")).commit();
    });
    for (int i = 0; i < 2000; ++i) {
      const std::string name = folder.file("other");
      const int fd = open(name.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
      ASSERT_GE(fd, 0);
      close(fd);
      ASSERT_EQ(mode_of(name), 0640U);
      ASSERT_EQ(unlink(name.c_str()), 0);
    }
  }
  umask(before);
  EXPECT_EQ(mode_of(folder.file("out")), 0640U);
}

TEST(AtomicFile, SizeIsTheFurthestByteWritten) {
  const TempFolder folder;
  AtomicFile file(folder.file("out"));
  file.append("0123456789");
  file.write_at(2, std::as_bytes(std::span(std::string_view("ab"))));
  EXPECT_EQ(file.size(), 10U);
  file.append("x");
  file.commit();
  EXPECT_EQ(folder.read("out"), "01ab456789x");
}

TEST(AtomicFile, WritesWhereSymlinksPoint) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.file("disk"));
  for (const bool exists : {true, false}) {
    const std::string name = exists ? "old" : "new", file = "disk/" + name;
    if (exists) folder.write(file, "before");
    std::filesystem::create_symlink(file, folder.file(name));  // relative to its own folder
    std::filesystem::create_symlink(folder.file(name), folder.file(name + "_link"));
    AtomicFile output(folder.file(name + "_link"));
    output.append("after");
    EXPECT_EQ(std::filesystem::exists(folder.file(file)), exists);
    output.commit();
    EXPECT_EQ(folder.read(file), "after");
    for (const char* end : {"", "_link"})
      EXPECT_TRUE(std::filesystem::is_symlink(folder.file(name + end)));
  }
}

TEST(AtomicFile, RejectsALoopOfSymlinks) {
  const TempFolder folder;
  std::filesystem::create_symlink("b", folder.file("a"));
  std::filesystem::create_symlink("a", folder.file("b"));
  EXPECT_SVDAG_ERROR(AtomicFile(folder.file("a")), ExitCode::kOutput, "loop of symbolic links");
}

TEST(AtomicFile, RejectsTargetsThatAreNotRegularFiles) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.file("folder"));
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/null", folder.file("device"));
  std::filesystem::create_symlink("/proc/self/fd/1", folder.file("stdout"));
  for (const char* name : {"pipe", "device", "stdout"})
    EXPECT_SVDAG_ERROR(AtomicFile(folder.file(name)), ExitCode::kOutput, "is not a regular file");
  EXPECT_SVDAG_ERROR(AtomicFile(folder.file("folder")), ExitCode::kOutput, "is a folder");
  EXPECT_SVDAG_ERROR(AtomicFile("/dev/null"), ExitCode::kOutput, "is not a regular file");
  EXPECT_TRUE(std::filesystem::is_fifo(folder.file("pipe")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("device")));
  EXPECT_EQ(folder.entries(), 4U);
}

TEST(AtomicFile, CommitRejectsTargetsCreatedMeanwhile) {
  const TempFolder folder;
  {
    AtomicFile to_folder(folder.file("folder")), to_pipe(folder.file("pipe"));
    std::filesystem::create_directory(folder.file("folder"));
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    EXPECT_SVDAG_ERROR(to_folder.commit(), ExitCode::kOutput, "folder: is a folder");
    EXPECT_SVDAG_ERROR(to_pipe.commit(), ExitCode::kOutput, "pipe: is not a regular file");
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder.file("pipe")));
  EXPECT_EQ(folder.entries(), 2U);
}

TEST(AtomicFile, WritesTheLongestNameAndRejectsALongerOneAtOnce) {
  const TempFolder folder;
  AtomicFile file(folder.file(std::string(255, 'n')));
  file.append("new");
  file.commit();
  EXPECT_EQ(folder.read(std::string(255, 'n')), "new");
  EXPECT_SVDAG_ERROR(AtomicFile(folder.file(std::string(256, 'n'))), ExitCode::kOutput,
                     "the file name is too long: choose a shorter one");
}

}  // namespace
}  // namespace svdag
