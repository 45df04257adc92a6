// Output of Progress.
#include "streaming/process/progress.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace svdag {
namespace {

std::string drawn(Progress::Mode mode, uint64_t total, uint64_t steps) {
  testing::internal::CaptureStderr();
  {
    Progress progress(mode);
    progress.phase("split", total);
    if (steps != 0) progress.advance(steps);
  }
  return testing::internal::GetCapturedStderr();
}

TEST(Progress, ShowsAPhaseAtItsBeginAndErasesTheLineAtTheEnd) {
  EXPECT_EQ(drawn(Progress::Mode::kOn, 0, 0), "\rsplit\r     \r");
}

TEST(Progress, ShowsTheCountOrTheShareOfSteps) {
  EXPECT_NE(drawn(Progress::Mode::kOn, 0, 7).find("\rsplit 7"), std::string::npos);
  EXPECT_NE(drawn(Progress::Mode::kOn, 4, 1).find("\rsplit  25 %"), std::string::npos);
}

TEST(Progress, PhasesInIntervalsAdvanceOneShare) {
  testing::internal::CaptureStderr();
  {
    Progress progress(Progress::Mode::kOn);
    const Progress::Interval second(&progress, 0.5, 1);
    for (const double begin : {0.0, 0.5}) {
      const Progress::Interval quarter(&progress, begin, begin + 0.5);
      progress.phase("bin", 4);
      progress.advance(2);
      EXPECT_EQ(progress.share(), 0.5 + begin / 2 + 0.125);
    }
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("\rbin  50 %\rbin  62 %"), std::string::npos) << text;
  EXPECT_NE(text.find("\rbin  75 %\rbin  88 %"), std::string::npos) << text;
}

TEST(Progress, EstimatesTheRemainingTimeWithoutSkippedWork) {
  testing::internal::CaptureStderr();
  {
    Progress progress(Progress::Mode::kOn);
    Progress::Interval half(&progress, 0, 0.5);
    progress.skip();
    half.move_to(0.5, 1);
    progress.phase("voxelize", 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(1600));
    progress.advance(1);  // a quarter of what is left
    EXPECT_EQ(half.share(), 0.25);
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("about 0:05 left"), std::string::npos) << text;
}

TEST(Progress, UsesNoEscapeSequence) {
  EXPECT_EQ(drawn(Progress::Mode::kOn, 4, 1).find('\033'), std::string::npos);
}

TEST(Progress, IsSilentUnlessEnabled) {
  EXPECT_EQ(drawn(Progress::Mode::kOff, 4, 1), "");
  EXPECT_EQ(drawn(Progress::Mode::kAuto, 4, 1), "");  // stderr is not a terminal here
}

}  // namespace
}  // namespace svdag
