#include "streaming/file/file.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

std::string read_text(const File& file, uint64_t offset, size_t n) {
  std::string text(n, '\0');
  file.read_at(offset, std::as_writable_bytes(std::span(text)));
  return text;
}

TEST(File, ReadsAtAnOffset) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "0123456789"));
  EXPECT_EQ(file.size(), 10U);
  EXPECT_EQ(read_text(file, 3, 4), "3456");
  EXPECT_EQ(read_text(file, 0, 10), "0123456789");
}

TEST(File, ReadingPastTheEndNamesTheByteWhereTheFileEnds) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("short", "0123456789"));
  EXPECT_SVDAG_ERROR(read_text(file, 8, 5), ExitCode::kBadInput,
                     "short: ends too early (at byte 10)");
}

TEST(File, ReadSomeStopsAtTheEnd) {
  const TempFolder folder;
  const File file = File::open_read(folder.write("a", "0123456789"));
  std::byte out[8];
  EXPECT_EQ(file.read_some_at(7, out), 3U);
  EXPECT_EQ(file.read_some_at(10, out), 0U);
  EXPECT_EQ(file.read_some_at(1000, out), 0U);
}

TEST(File, RejectsFilesThatAreNotRegular) {
  const TempFolder folder;
  EXPECT_SVDAG_ERROR(File::open_read(folder.file("none")), ExitCode::kBadInput, "no such file");
  EXPECT_SVDAG_ERROR(File::open_read(folder.path()), ExitCode::kBadInput, "is a folder");
  EXPECT_SVDAG_ERROR(File::open_read("/dev/zero"), ExitCode::kBadInput, "not a regular file");
  // Opening a pipe without a writer must not block.
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_SVDAG_ERROR(File::open_read(folder.file("pipe")), ExitCode::kBadInput,
                     "not a regular file");
}

TEST(File, AnonymousFileIsInvisibleUntilLinked) {
  const TempFolder folder;
  {
    File file = File::create_anonymous(folder.path());
    file.write_at(0, bytes_of("abc"));
    EXPECT_EQ(read_text(file, 0, 3), "abc");
    file.link_as(folder.file("named"));
    EXPECT_EQ(file.path(), folder.file("named"));
    file.close();
    File::create_anonymous(folder.path()).write_at(0, bytes_of("lost"));
  }
  EXPECT_EQ(folder.entries(), 1U);
  EXPECT_EQ(folder.read("named"), "abc");
}

TEST(File, HolesReadAsZeros) {
  const TempFolder folder;
  File file = File::create_anonymous(folder.path());
  file.write_at(4, bytes_of("x"));
  EXPECT_EQ(file.size(), 5U);
  EXPECT_EQ(read_text(file, 0, 5), std::string("\0\0\0\0x", 5));
}

TEST(File, AFailedWriteIsAnOutputError) {
  const TempFolder folder;
  File file = File::open_read(folder.write("read-only", "abc"));
  EXPECT_SVDAG_ERROR(file.write_at(0, bytes_of("x")), ExitCode::kOutput,
                     "read-only: cannot be written");
}

TEST(File, AMissingFolderIsAnOutputError) {
  const TempFolder folder;
  EXPECT_SVDAG_ERROR(File::create_anonymous(folder.file("missing")), ExitCode::kOutput,
                     "missing: cannot write in this folder: no such file or folder");
}

TEST(File, AFailedReadOfAnOwnFileIsAnOutputError) {
  const TempFolder folder;
  File file = File::create_anonymous(folder.path());
  file.write_at(0, bytes_of("abc"));
  EXPECT_SVDAG_ERROR(read_text(file, 0, 4), ExitCode::kOutput, "ends too early (at byte 3)");
}

TEST(File, AnUnalignedDirectTransferUsesThePageCache) {
  const TempFolder folder;
  File file = File::create_anonymous(folder.path());
  file.use_direct();
  file.write_at(3, bytes_of("neither offset, size nor memory is aligned"));
  EXPECT_EQ(read_text(file, 11, 6), "offset");
  file.truncate(10);
  EXPECT_EQ(file.size(), 10U);
}

TEST(File, ALockIsExclusive) {
  const TempFolder folder;
  const std::string path = folder.write("a", "A");
  File second = File::open_read(path);
  {
    File first = File::open_read(path);
    EXPECT_TRUE(first.try_lock());
    EXPECT_FALSE(second.try_lock());
  }
  EXPECT_TRUE(second.try_lock());
}

TEST(File, MovingTransfersTheDescriptor) {
  const TempFolder folder;
  File a = File::open_read(folder.write("a", "A"));
  File b = File::open_read(folder.write("b", "B"));
  const int descriptor = b.descriptor();
  a = std::move(b);
  EXPECT_EQ(a.descriptor(), descriptor);
  EXPECT_EQ(b.descriptor(), -1);  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(read_text(a, 0, 1), "B");
}

TEST(File, FolderOfIsThePartBeforeTheLastSlash) {
  EXPECT_EQ(folder_of("a"), ".");
  EXPECT_EQ(folder_of("/a"), "/");
  EXPECT_EQ(folder_of("a/b/c"), "a/b");
  EXPECT_EQ(base_name("a"), "a");
  EXPECT_EQ(base_name("a/b/c"), "c");
}

// A lack of system resources is not an error of the file: a farm retries 4 and 5, but not 3.
TEST(File, TooManyOpenFilesAreAMemoryError) {
  const TempFolder folder;
  const std::string path = folder.write("a", "a");
  rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit few = {4, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  const auto open_some = [&] {
    std::vector<File> files;
    for (int i = 0; i < 8; ++i) files.push_back(File::open_read(path));
  };
  EXPECT_SVDAG_ERROR(open_some(), ExitCode::kMemory, "too many open files (ulimit -n)");
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

}  // namespace
}  // namespace svdag
