// A limited child sends its results; anything else that it does ends it with one message.
#include "streaming/process/limited_child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "tests/expect_error.h"
#include "tests/sanitized.h"

namespace svdag {
namespace {

using Work = std::function<void(const BlockSink&)>;

std::string result_of(const Work& work, const ChildLimits& limits = {uint64_t(64) << 20, 1}) {
  std::string all;
  run_limited(limits, "x.drc", work, [&](std::span<const std::byte> bytes) {
    all.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
  return all;
}

void expect_stopped(const Work& work, const char* reason) {
  EXPECT_SVDAG_ERROR(result_of(work), ExitCode::kBadInput, "x.drc: the decoder was stopped: ");
  if (!kSanitized) EXPECT_SVDAG_ERROR(result_of(work), ExitCode::kBadInput, reason);
}

TEST(LimitedChild, SendsItsResults) {
  EXPECT_EQ(result_of([](const BlockSink&) {}), "");
  std::string made(3 * kChildBlock + 7, 'a');
  for (size_t i = 0; i < made.size(); ++i) made[i] = char(i % 251);
  EXPECT_EQ(result_of([&](const BlockSink& out) {
              out(std::as_bytes(std::span(made).first(5)));
              out(std::as_bytes(std::span(made).subspan(5)));
            }),
            made);
}

TEST(LimitedChild, DoesNotChangeTheParent) {
  int here = 1;
  result_of([&](const BlockSink&) { here = 2; });
  EXPECT_EQ(here, 1);
}

TEST(LimitedChild, ItsErrorsAreRethrown) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer needs system calls when something is thrown";
  EXPECT_SVDAG_ERROR(
      result_of([](const BlockSink&) { fail_input("x.drc", "has no triangles", 12); }),
      ExitCode::kBadInput, "x.drc: has no triangles (at byte 12)");
  EXPECT_SVDAG_ERROR(
      result_of([](const BlockSink&) { throw Error(ExitCode::kMemory, "needs more"); }),
      ExitCode::kMemory, "needs more");
}

TEST(LimitedChild, ACrashIsAnError) {
  expect_stopped([](const BlockSink&) { __builtin_trap(); }, "it crashed");
  expect_stopped([](const BlockSink&) { std::abort(); }, "it crashed");
  expect_stopped([](const BlockSink&) { ::_exit(0); }, "it ended without a result");
  expect_stopped([](const BlockSink&) { throw 7; }, "it ended without a result");
}

TEST(LimitedChild, CannotExceedItsMemoryLimit) {
  expect_stopped(
      [](const BlockSink& out) {
        std::vector<std::byte> large(size_t(4) << 30, std::byte(1));
        out(std::span(large).first(9));
      },
      "it needs more memory than it may have");
  if (!kSanitized) {
    EXPECT_EQ(result_of([](const BlockSink& out) {
                const std::vector<std::byte> fits(size_t(32) << 20, std::byte('b'));
                out(std::span(fits).last(2));
              }),
              "bb");
  }
}

TEST(LimitedChild, CannotExceedItsTimeLimit) {
  expect_stopped(
      [](const BlockSink&) {
        volatile bool forever = true;
        while (forever) {
        }
      },
      "it took more than 1 s of processor time");
}

TEST(LimitedChild, CannotUseFilesNetworkOrProcesses) {
  const char* reason = "it made a forbidden system call";
  EXPECT_EQ(result_of([](const BlockSink& out) {
              const bool opened = ::open("/etc/passwd", O_RDONLY) >= 0 || errno != EPERM;
              out(std::as_bytes(std::span(opened ? "yes" : "no", opened ? 3 : 2)));
            }),
            "no");
  expect_stopped([](const BlockSink&) { ::unlink("/tmp/nothing-of-this-name"); }, reason);
  expect_stopped([](const BlockSink&) { ::socket(AF_INET, SOCK_STREAM, 0); }, reason);
  expect_stopped([](const BlockSink&) { ::fork(); }, reason);
  expect_stopped([](const BlockSink&) { ::kill(::getppid(), 0); }, reason);
  expect_stopped([](const BlockSink&) { ::execl("/bin/true", "true", nullptr); }, reason);
}

TEST(LimitedChild, WithoutAFilterItsCrashesAreStillContained) {
  const auto run = [](const Work& work) {
    run_limited({uint64_t(64) << 20, 1, false}, "x.om", work, [](std::span<const std::byte>) {});
  };
  run([](const BlockSink&) { ::getppid(); });
  EXPECT_SVDAG_ERROR(run([](const BlockSink&) { std::abort(); }), ExitCode::kBadInput,
                     "x.om: the decoder was stopped: it crashed");
}

TEST(LimitedChild, CannotReadFilesOfItsParent) {
  const int secret = ::open("/proc/self/status", O_RDONLY);
  ASSERT_GE(secret, 0);
  EXPECT_EQ(result_of([&](const BlockSink& out) {
              char byte = 0;
              const bool readable = ::read(secret, &byte, 1) > 0 || ::read(0, &byte, 1) >= 0;
              out(std::as_bytes(std::span(readable ? "yes" : "no", readable ? 3 : 2)));
            }),
            "no");
  ::close(secret);
}

TEST(LimitedChild, EndsIfTheCallerThrows) {
  struct Enough {};
  const Work endless = [](const BlockSink& out) {
    for (const std::vector<std::byte> block(1000);;) out(block);
  };
  EXPECT_THROW(run_limited({uint64_t(64) << 20, 2}, "x.drc", endless,
                           [](std::span<const std::byte>) { throw Enough(); }),
               Enough);
}

// glibc unlocks its allocator in the child. That of a sanitizer may stay locked by a thread that
// the child does not have.
TEST(LimitedChild, WorksWithOtherThreadsInTheParent) {
  if (kSanitized) GTEST_SKIP() << "the allocator of a sanitizer may be locked in the child";
  const std::jthread busy([](const std::stop_token& end) {
    while (!end.stop_requested()) std::vector<char>(1000).assign(900, 'x');
  });
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(result_of([](const BlockSink& out) {
                const std::vector<std::byte> made(10'000, std::byte('c'));
                out(std::span(made).first(3));
              }),
              "ccc");
  }
}

}  // namespace
}  // namespace svdag
