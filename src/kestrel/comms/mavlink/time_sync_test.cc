// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/time_sync.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

// Two clocks and the line between them: delays are uniform from 'least_s' to 'most_s'.
class SimulatedClocks {
 public:
  SimulatedClocks(unsigned seed, double drift, double least_s, double most_s)
      : random_(seed), drift_(drift), delay_s_(least_s, most_s) {}

  Time Local(double time_s) const {
    return TimeFromNanoseconds(1'000'000'000'000'000) + DurationFromSeconds(time_s);
  }
  std::int64_t Remote(double time_s) const {
    return 7'000'000'000 + std::llround(1e9 * ((1 + drift_) * time_s + jump_s_));
  }
  void Jump(double by_s) { jump_s_ += by_s; }

  // Sends a request at 'time_s'.
  void Request(double time_s, TimeSync* sync) {
    const double there_s = time_s + delay_s_(random_);
    sync->AddRoundTrip(Local(time_s), Remote(there_s), Local(there_s + delay_s_(random_)));
  }
  void Notify(double time_s, TimeSync* sync) {
    sync->AddOneWay(Remote(time_s), Local(time_s + delay_s_(random_)));
  }
  double ErrorOf(const TimeSync& sync, double time_s) const {
    return ToSeconds(sync.ToLocal(Remote(time_s)) - Local(time_s));
  }

 private:
  std::mt19937 random_;
  double drift_;
  double jump_s_ = 0;
  std::uniform_real_distribution<double> delay_s_;
};

TEST(TimeSyncTest, ConvergesWithinMillisecondInTenSeconds) {
  constexpr int kRuns = 200;
  std::vector<double> errors_s;
  double within_sigma = 0;
  for (int run = 0; run < kRuns; ++run) {
    SimulatedClocks clocks(run, run % 2 == 0 ? 50e-6 : -50e-6, 0.005, 0.05);
    TimeSync sync;
    for (int i = 0; i < 200; ++i) clocks.Request(0.05 * i, &sync);
    ASSERT_TRUE(sync.is_known());
    errors_s.push_back(std::abs(clocks.ErrorOf(sync, 10)));
    if (errors_s.back() < sync.sigma_s(clocks.Local(10))) ++within_sigma;
  }
  std::sort(errors_s.begin(), errors_s.end());
  RecordProperty("median_us", static_cast<int>(1e6 * errors_s[kRuns / 2]));
  RecordProperty("p99_us", static_cast<int>(1e6 * errors_s[kRuns - 2]));
  EXPECT_LT(errors_s[kRuns / 2], 0.4e-3);
  EXPECT_LT(errors_s[kRuns - 2], 1e-3);
  EXPECT_GT(within_sigma / kRuns, 0.6);
  EXPECT_LT(within_sigma / kRuns, 0.99);
}

TEST(TimeSyncTest, FollowsDrift) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    SimulatedClocks clocks(seed, 50e-6, 0.005, 0.05);
    TimeSync sync;
    for (int i = 0; i < 1200; ++i) {
      clocks.Request(0.1 * i, &sync);
      if (i > 300) {
        EXPECT_LT(std::abs(clocks.ErrorOf(sync, 0.1 * i)), 1e-3) << i;
      }
    }
    EXPECT_NEAR(sync.drift(), 50e-6, 30e-6);
    EXPECT_GT(sync.round_trip(), std::chrono::milliseconds(9));
    EXPECT_EQ(sync.jumps(), 0);
  }
}

TEST(TimeSyncTest, ConvertsBothWays) {
  SimulatedClocks clocks(1, 30e-6, 0.001, 0.002);
  TimeSync sync;
  for (int i = 0; i < 100; ++i) clocks.Request(0.1 * i, &sync);
  const std::int64_t remote_ns = clocks.Remote(12);
  EXPECT_NEAR(sync.ToRemote(sync.ToLocal(remote_ns)), remote_ns, 2);
  EXPECT_NEAR(ToSeconds(sync.ToLocal(remote_ns) - clocks.Local(12)), 0, 0.3e-3);
}

TEST(TimeSyncTest, DetectsRestartOfOtherComputer) {
  for (const double jump_s : {-100.0, -2.0, 2.0, 1000.0}) {
    SimulatedClocks clocks(2, 0, 0.005, 0.05);
    TimeSync sync;
    for (int i = 0; i < 100; ++i) clocks.Request(0.1 * i, &sync);
    clocks.Jump(jump_s);
    double noticed_s = 0;
    for (int i = 100; i < 120; ++i) {
      clocks.Request(0.1 * i, &sync);
      if (noticed_s == 0 && sync.jumps() == 1) noticed_s = 0.1 * (i - 100);
    }
    EXPECT_GT(noticed_s, 0) << jump_s;
    EXPECT_LT(noticed_s, 1) << jump_s;
    EXPECT_EQ(sync.jumps(), 1) << jump_s;
    ASSERT_TRUE(sync.is_known());
    EXPECT_LT(std::abs(clocks.ErrorOf(sync, 12)), 0.03) << jump_s;
  }
}

// A simulated ArduPilot on a computer with other work.
TEST(TimeSyncTest, FollowsClockThatStallsAndCatchesUp) {
  for (const double stall_s : {-0.2, 0.2}) {
    SimulatedClocks clocks(2, 0, 0.005, 0.05);
    TimeSync sync;
    for (int i = 0; i < 100; ++i) clocks.Request(0.1 * i, &sync);
    clocks.Jump(stall_s);
    for (int i = 100; i < 130; ++i) clocks.Request(0.1 * i, &sync);
    EXPECT_EQ(sync.jumps(), 0) << stall_s;
    EXPECT_LT(std::abs(clocks.ErrorOf(sync, 13)), 0.03) << stall_s;
  }
}

// A simulated PX4 loses a percent of its time, more while the computer has other work.
TEST(TimeSyncTest, FollowsSimulatedClockFromSecondToSecond) {
  for (const double drift : {-0.011, -0.03, 0.011}) {
    SimulatedClocks clocks(5, drift, 0.0001, 0.0003);
    TimeSync sync;
    for (int i = 0; i < 600; ++i) {
      const double time_s = 0.05 * i;
      clocks.Request(time_s, &sync);
      if (i % 100 == 99) clocks.Jump(0.004);  // it was delayed
      if (i < 60) continue;
      ASSERT_TRUE(sync.is_known());
      EXPECT_LT(std::abs(clocks.ErrorOf(sync, time_s)), 0.012) << drift << " " << time_s;
    }
    EXPECT_EQ(sync.jumps(), 0);
    clocks.Jump(-30);
    for (int i = 600; i < 620; ++i) clocks.Request(0.05 * i, &sync);
    EXPECT_EQ(sync.jumps(), 1);
  }
}

// A simulated autopilot: it stalls, answers nothing meanwhile, and catches up at three times its
// rate.
class StallingClock {
 public:
  StallingClock(unsigned seed, double rate) : random_(seed), rate_(rate) {}

  Time Local(double time_s) const {
    return TimeFromNanoseconds(std::llround(1e9 * (100 + time_s)));
  }
  // Its typical time.
  std::int64_t Mostly(double time_s) const { return std::llround(1e9 * (50 + rate_ * time_s)); }

  void Request(double time_s, TimeSync* sync) {
    constexpr double kEvery_s = 3;
    std::uniform_real_distribution<double> delay_s(0.0002, 0.002);
    std::uniform_real_distribution<double> part(0, 1);
    if (time_s > stall_end_s_ + stall_s_ && part(random_) < 0.1 / kEvery_s) {
      stall_s_ = 0.02 + 0.08 * part(random_);
      stall_end_s_ = time_s + stall_s_ * part(random_);
    }
    const double there_s = std::max(time_s + delay_s(random_), stall_end_s_);
    const double behind_s = std::max(0.0, stall_s_ - 2 * (there_s - stall_end_s_));
    const std::int64_t shown_ns = Mostly(there_s) - std::llround(1e9 * behind_s);
    sync->AddRoundTrip(Local(time_s), shown_ns, Local(there_s + delay_s(random_)));
  }
  double ErrorOf(const TimeSync& sync, double time_s) const {
    return ToSeconds(sync.ToLocal(Mostly(time_s)) - Local(time_s));
  }

 private:
  std::mt19937 random_;
  double rate_;
  double stall_s_ = 0;
  double stall_end_s_ = -10;
};

TEST(TimeSyncTest, IsStableWhileSimulatedClockStalls) {
  for (const double rate : {0.99, 1.0}) {
    std::vector<double> errors_s;
    for (unsigned seed = 0; seed < 10; ++seed) {
      StallingClock clock(seed, rate);
      TimeSync sync;
      for (int i = 0; i < 1200; ++i) {
        clock.Request(0.1 * i, &sync);
        if (i < 100) continue;
        // Until just before the next request.
        for (const double later_s : {0.0, 0.05, 0.1}) {
          errors_s.push_back(std::abs(clock.ErrorOf(sync, 0.1 * i + later_s)));
        }
      }
      EXPECT_EQ(sync.jumps(), 0);
    }
    std::sort(errors_s.begin(), errors_s.end());
    const double p99_s = errors_s[errors_s.size() * 99 / 100];
    RecordProperty(rate < 1 ? "slow_p99_us" : "p99_us", static_cast<int>(1e6 * p99_s));
    RecordProperty(rate < 1 ? "slow_most_us" : "most_us", static_cast<int>(1e6 * errors_s.back()));
    EXPECT_LT(p99_s, 0.005) << rate;
    EXPECT_LT(errors_s.back(), 0.02) << rate;
  }
}

TEST(TimeSyncTest, FollowsSimulatedClockThatSlowsDown) {
  SimulatedClocks clocks(5, -0.01, 0.0001, 0.0003);
  TimeSync sync;
  for (int i = 0; i < 200; ++i) clocks.Request(0.1 * i, &sync);
  EXPECT_NEAR(sync.drift(), -0.01, 3e-4);
  // Two percent from now on.
  double most_s = 0;
  for (int i = 200; i < 400; ++i) {
    clocks.Jump(-0.001);
    clocks.Request(0.1 * i, &sync);
    most_s = std::max(most_s, std::abs(clocks.ErrorOf(sync, 0.1 * i)));
  }
  EXPECT_LT(most_s, 0.02);
  EXPECT_NEAR(sync.drift(), -0.02, 1e-3);
  EXPECT_LT(std::abs(clocks.ErrorOf(sync, 40)), 0.003);
}

TEST(TimeSyncTest, OneForgedAnswerChangesNothing) {
  SimulatedClocks clocks(3, 0, 0.005, 0.02);
  TimeSync sync;
  for (int i = 0; i < 100; ++i) {
    clocks.Request(0.1 * i, &sync);
    if (i % 5 == 4) sync.AddRoundTrip(clocks.Local(0.1 * i), 12345, clocks.Local(0.1 * i + 0.01));
  }
  EXPECT_EQ(sync.jumps(), 0);
  EXPECT_LT(std::abs(clocks.ErrorOf(sync, 10)), 2e-3);
}

TEST(TimeSyncTest, KeepsEstimateDuringPause) {
  SimulatedClocks clocks(4, 20e-6, 0.005, 0.05);
  TimeSync sync;
  for (int i = 0; i < 300; ++i) clocks.Request(0.1 * i, &sync);
  const double before_s = sync.sigma_s(clocks.Local(30));
  EXPECT_GT(sync.sigma_s(clocks.Local(90)), before_s);
  for (int i = 900; i < 910; ++i) {
    clocks.Request(0.1 * i, &sync);
    EXPECT_LT(std::abs(clocks.ErrorOf(sync, 0.1 * i)), 3e-3);
  }
}

TEST(TimeSyncTest, EstimatesRoughlyFromOneWayMessages) {
  SimulatedClocks clocks(5, 0, 0.005, 0.02);
  TimeSync sync;
  for (int i = 0; i < 30; ++i) clocks.Notify(0.1 * i, &sync);
  ASSERT_TRUE(sync.is_known());
  EXPECT_LT(std::abs(clocks.ErrorOf(sync, 3)), sync.sigma_s(clocks.Local(3)));
  EXPECT_GT(sync.sigma_s(clocks.Local(3)), 0.01);
}

}  // namespace
}  // namespace kestrel
