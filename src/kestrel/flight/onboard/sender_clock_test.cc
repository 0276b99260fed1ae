// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/sender_clock.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kPeriod_s = 1.0 / 30;

// Frames of a sender whose clock is decades off and drifts, over a line that delays each frame.
class Sender {
 public:
  explicit Sender(double drift_ppm = 0) : drift_(1e-6 * drift_ppm) {}

  // Returns how far the mapped time of the next frame is after the sending. 'delay_s': of the line;
  // 'step': of the sender's clock, for this frame and for all after it if 'stays'.
  double Next(double delay_s, Duration step = {}, bool stays = false) {
    const Time sent = Time(seconds(1000)) + DurationFromSeconds(frame_ * kPeriod_s);
    const Time stamp = Time(seconds(2'000'000'000)) + step_ + step +
                       DurationFromSeconds(frame_ * kPeriod_s * (1 + drift_));
    if (stays) step_ += step;
    ++frame_;
    return ToSeconds(clock_.Map(stamp, sent + DurationFromSeconds(delay_s)) - sent);
  }

 private:
  SenderClock clock_;
  double drift_;
  Duration step_{};
  int frame_ = 0;
};

// Of a line that is never faster than 100 ms, seldom much slower.
double Jittered(Random* random) { return 0.1 + 0.02 * std::abs(random->Normal()); }

TEST(SenderClockTest, LocalTimesHaveIntervalsOfStamps) {
  for (const double drift_ppm : {-100.0, 0.0, 100.0}) {
    Random random(5);
    Sender sender(drift_ppm);
    for (int i = 0; i < 300; ++i) sender.Next(Jittered(&random));
    for (int i = 0; i < 20000; ++i) ASSERT_NEAR(sender.Next(Jittered(&random)), 0.1, 0.0025) << i;
  }
}

TEST(SenderClockTest, SlowLineDoesNotDelayTimes) {
  Sender sender;
  for (int i = 0; i < 100; ++i) sender.Next(0.1);
  for (int i = 0; i < 300; ++i) EXPECT_NEAR(sender.Next(0.1 + 0.005 * i), 0.1, 0.003);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(sender.Next(0.1), 0.1, 0.003);
}

TEST(SenderClockTest, SingleOddStampsAreIgnored) {
  Random random(7);
  Sender sender;
  for (int i = 0; i < 100; ++i) sender.Next(Jittered(&random));
  for (const Duration odd : std::vector<Duration>{seconds(5), -seconds(5), milliseconds(400)}) {
    EXPECT_NEAR(sender.Next(Jittered(&random), odd), 0.1, 0.08);
    EXPECT_NEAR(sender.Next(Jittered(&random)), 0.1, 0.002);
  }
}

TEST(SenderClockTest, MappingBeginsAnewWhenClockIsSet) {
  for (const Duration step : std::vector<Duration>{-seconds(3600), seconds(3600), -seconds(1)}) {
    Random random(9);
    Sender sender;
    for (int i = 0; i < 100; ++i) sender.Next(Jittered(&random));
    EXPECT_NEAR(sender.Next(Jittered(&random), step, true), 0.1, 0.08);
    for (int i = 0; i < 60; ++i) EXPECT_NEAR(sender.Next(Jittered(&random)), 0.1, 0.08);
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(sender.Next(Jittered(&random)), 0.1, 0.005);
  }
}

}  // namespace
}  // namespace kestrel
