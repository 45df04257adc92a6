#include "streaming/file/mapped_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "streaming/file/atomic_file.h"
#include "streaming/process/program.h"
#include "tests/expect_error.h"
#include "tests/temp_folder.h"

namespace svdag {
namespace {

constexpr size_t kMappedSize = 3 << 16;

MappedFile map(const std::string& path, size_t size) {
  File file = File::open_read(path);
  const FileState before = state_of(file);
  return {std::move(file), size, before};
}

char byte_at(const MappedFile& file, size_t offset) {
  return *(static_cast<const volatile char*>(file.data()) + offset);
}

TEST(MappedFile, HasTheBytesOfTheFileEvenAfterAMove) {
  const TempFolder folder;
  const std::string text(kMappedSize, 'x');
  MappedFile mapped = map(folder.write("a", text), kMappedSize);
  const MappedFile moved = std::move(mapped);
  EXPECT_EQ(std::memcmp(moved.data(), text.data(), kMappedSize), 0);
}

TEST(MappedFile, RejectsAnEmptyFile) {
  const TempFolder folder;
  EXPECT_SVDAG_ERROR(map(folder.write("a", ""), 0), ExitCode::kBadInput,
                     "a: cannot be mapped into memory");
}

// Reads some files as a program does, after file `which` was truncated.
void read_a_lost_page(const TempFolder& folder, int which) {
  std::vector<MappedFile> files;
  for (int i = 0; i < 3; ++i) {
    const std::string path = folder.write("file " + std::to_string(i), std::string(kMappedSize, 'x'));
    files.push_back(map(path, kMappedSize));
    if (i == which && ::truncate(path.c_str(), 10) != 0) ::_exit(99);
  }
  install_lost_page_handlers("svdag");
  for (const MappedFile& file : files) {
    if (byte_at(file, 0) != 'x') ::_exit(98);  // in the first page, which still exists
  }
  for (const MappedFile& file : files) byte_at(file, kMappedSize - 1);
}

TEST(MappedFile, ALostPageIsReportedWithTheFileName) {
  const TempFolder folder;
  for (const int which : {0, 1, 2}) {
    EXPECT_EXIT(read_a_lost_page(folder, which), testing::ExitedWithCode(int(ExitCode::kBadInput)),
                "^svdag: [^\n]*file " + std::to_string(which) +
                    ": can no longer be read: it was cut short, or its disk failed\n$");
  }
}

// The rest of a truncated file's last page reads as zeros, without a signal.
TEST(MappedFile, NoOutputIsCommittedWhileAMappedFileHasChanged) {
  const TempFolder folder;
  const std::string path = folder.write("a", std::string(kMappedSize, 'x'));
  const std::string output = folder.write("out", "old");
  {
    const MappedFile mapped = map(path, kMappedSize);
    ASSERT_EQ(::truncate(path.c_str(), kMappedSize - 1), 0);
    EXPECT_EQ(byte_at(mapped, kMappedSize - 1), 0);
    AtomicFile file(output);
    file.append("new");
    EXPECT_SVDAG_ERROR(file.commit(), ExitCode::kBadInput, "a: was changed while it was read");
  }
  EXPECT_EQ(File::open_read(output).size(), 3U);
  AtomicFile file(output);
  file.append("newer");
  file.commit();  // works again, since the changed file is not mapped
  EXPECT_EQ(File::open_read(output).size(), 5U);
}

// Runs in a new process, in which no other file has changed.
TEST(MappedFile, AProgramWhoseFileChangedFails) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TempFolder folder;
  const std::string path = folder.write("a", std::string(kMappedSize, 'x'));
  EXPECT_EXIT(::_exit(run_program({.name = "svdag"},
                                  [&] {
                                    const MappedFile mapped = map(path, kMappedSize);
                                    return ::truncate(path.c_str(), kMappedSize - 1);
                                  })),
              testing::ExitedWithCode(int(ExitCode::kBadInput)),
              "a: was changed while it was read");
}

// True unless the process exited with kBadInput.
bool ended_otherwise(int status) {
  return !WIFEXITED(status) || WEXITSTATUS(status) != int(ExitCode::kBadInput);
}

// Content that changed after the check may cause any error.
void fail_after(bool written, const std::string& path, const std::function<void()>& fail) {
  ::_exit(run_program({.name = "svdag", .no_memory = "no memory"}, [&] {
    const MappedFile mapped = map(path, kMappedSize);
    if (written) std::ofstream(path, std::ios::app) << "more";
    fail();
    return 0;
  }));
}

TEST(MappedFile, AChangeIsReportedInsteadOfTheErrorThatItCaused) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TempFolder folder;
  const auto new_file = [&] { return folder.write("a", std::string(kMappedSize, 'x')); };
  const auto segfault = [] {
    const volatile uintptr_t address = 16;
    *reinterpret_cast<volatile char*>(address) = 1;
  };
  const auto assertion = [] { SVDAG_ASSERT(false); };
  const auto range = [] { throw std::out_of_range("at"); };
  const auto usage = [] { fail_usage("a: has no voxel"); };
  const testing::ExitedWithCode bad(int(ExitCode::kBadInput)), internal(int(ExitCode::kInternal));
  EXPECT_EXIT(fail_after(true, new_file(), segfault), bad, "a: was changed while it was read\n$");
  EXPECT_EXIT(fail_after(true, new_file(), assertion), bad, "a: was changed while it was read\n$");
  EXPECT_EXIT(fail_after(true, new_file(), range), bad, "a: was changed while it was read\n$");
  EXPECT_EXIT(fail_after(true, new_file(), usage), bad, "a: was changed while it was read\n$");
  EXPECT_EXIT(fail_after(false, new_file(), assertion), internal, "please report");
  EXPECT_EXIT(fail_after(false, new_file(), range), internal, "internal error: at; please report");
  EXPECT_EXIT(fail_after(false, new_file(), segfault), ended_otherwise, "");
}

TEST(MappedFile, ASignalOfAnotherCauseKeepsItsEffect) {
  const TempFolder folder;
  EXPECT_EXIT(
      {
        const MappedFile mapped = map(folder.write("a", "x"), 1);
        install_lost_page_handlers("svdag");
        raise(SIGBUS);
        ::_exit(int(ExitCode::kBadInput));
      },
      ended_otherwise, "");
}

TEST(MappedFile, ManyFilesCanBeMapped) {
  const TempFolder folder;
  const std::string path = folder.write("a", "x");
  std::vector<MappedFile> files;
  for (int i = 0; i < 100; ++i) files.push_back(map(path, 1));
  for (const MappedFile& each : files) EXPECT_EQ(byte_at(each, 0), 'x');
}

}  // namespace
}  // namespace svdag
