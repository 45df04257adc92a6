#include "streaming/process/stage.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

namespace svdag {
namespace {

using Values = std::vector<int>;

// Either side may be the slower one.
TEST(Stage, TakesEveryValueInOrder) {
  for (const bool has_thread : {false, true}) {
    for (const int slow : {0, 1, 2}) {
      const auto delay = [&](int side, int i) {
        if (side == slow) std::this_thread::sleep_for(std::chrono::microseconds(i * 7919 % 200));
      };
      Values taken;
      Stage<Values> stage(has_thread, [&](const Values& values) {
        delay(1, values[0]);
        taken.insert(taken.end(), values.begin(), values.end());
      });
      Values next, all;
      for (int i = 0; i < 500; ++i) {
        next = {i, -i};
        all.insert(all.end(), {i, -i});
        delay(2, i);
        stage.put(&next);
      }
      stage.finish();
      EXPECT_EQ(taken, all);
    }
  }
}

TEST(Stage, RethrowsWhatTakeThrows) {
  for (const bool has_thread : {false, true}) {
    const auto run = [&] {
      Stage<Values> stage(has_thread, [&](const Values& values) {
        if (values[0] == 3) throw std::runtime_error("three");
      });
      Values next;
      for (int i = 0; i < 100; ++i) {
        next = {i};
        stage.put(&next);
      }
      stage.finish();
    };
    EXPECT_THROW(run(), std::runtime_error);
  }
}

TEST(Stage, AnErrorOfTheLastValueIsThrownByFinish) {
  Stage<Values> stage(true, [](const Values&) { throw std::runtime_error("last"); });
  Values last{1};
  stage.put(&last);
  EXPECT_THROW(stage.finish(), std::runtime_error);
}

TEST(Stage, StopsWhenTheCallerFails) {
  const auto run = [] {
    Stage<Values> stage(true, [](const Values&) {});
    Values next{1};
    stage.put(&next);
    throw std::runtime_error("caller");
  };
  EXPECT_THROW(run(), std::runtime_error);
}

}  // namespace
}  // namespace svdag
