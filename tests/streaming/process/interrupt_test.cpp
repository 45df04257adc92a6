#include "streaming/process/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

namespace svdag {
namespace {

// Runs `work` in a child process and returns its wait status.
int status_of(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

int caught() {
  try {
    check_interrupt();
    return 0;
  } catch (const Interrupted& interrupted) {
    return interrupted.signal;
  }
}

TEST(Interrupt, NothingIsThrownBeforeASignal) {
  EXPECT_EQ(caught(), 0);
  pretend_interrupt(SIGTERM);
  EXPECT_EQ(caught(), SIGTERM);
  EXPECT_EQ(caught(), SIGTERM);  // again, for every thread that checks
  pretend_interrupt(0);
  EXPECT_EQ(caught(), 0);
}

TEST(Interrupt, EachSignalIsReportedWithItsNumber) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const int status = status_of([&] {
      catch_interrupts();
      if (caught() != 0) return 1;
      raise(number);
      return caught() == number ? 0 : 2;
    });
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0) << number;
  }
}

TEST(Interrupt, ASecondSignalOfAnyKindKills) {
  for (const int second : {SIGINT, SIGTERM, SIGHUP}) {
    const int status = status_of([&] {
      catch_interrupts();
      raise(SIGINT);
      raise(second);
      return 0;
    });
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), second);
  }
}

TEST(Interrupt, IgnoredSignalsStayIgnored) {
  const int status = status_of([] {
    signal(SIGHUP, SIG_IGN);
    catch_interrupts();
    raise(SIGHUP);
    if (caught() != 0) return 1;
    raise(SIGINT);
    raise(SIGHUP);
    return caught() == SIGINT ? 0 : 2;
  });
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace svdag
