// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/guard/flight_guard.h"

#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

class FlightGuardTest : public ::testing::Test {
 protected:
  struct Sent {
    int set_points = 0;
    int levels = 0;
    std::vector<FlightMode> modes;
    std::string text;
    SetPoint stop;  // the last
  };

  // The program flies for 'ms', with a sign of life every 20 ms.
  void Fly(GuardTask task, AutopilotKind kind, int ms) {
    for (int i = 0; i < ms; i += kStep_ms) {
      now_ += milliseconds(kStep_ms);
      if (i % 20 == 0) guard_.TakeLife(task, kind, now_);
      guard_.TakeMode(is_guided_, now_);
      const GuardAction action = guard_.Update(now_);
      EXPECT_FALSE(action.stop || action.mode || action.text);
    }
  }

  // Nothing comes from the program for 'ms'.
  Sent BeSilent(int ms) {
    Sent sent;
    for (int i = 0; i < ms; i += kStep_ms) {
      now_ += milliseconds(kStep_ms);
      guard_.TakeMode(is_guided_, now_);
      if (velocity_) guard_.TakeVelocity(*velocity_, now_);
      const GuardAction action = guard_.Update(now_);
      sent.set_points += action.stop ? 1 : 0;
      if (action.stop) sent.stop = *action.stop;
      sent.levels += action.level ? 1 : 0;
      if (action.mode) sent.modes.push_back(*action.mode);
      if (action.text != nullptr) sent.text += std::string(action.text) + "\n";
    }
    return sent;
  }

  static constexpr int kStep_ms = 5;
  Time now_ = TimeFromNanoseconds(1'000'000'000);
  bool is_guided_ = true;
  std::optional<Eigen::Vector3d> velocity_;
  FlightGuard guard_{milliseconds(200)};
};

TEST_F(FlightGuardTest, DoesNothingWhileProgramLives) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 2000);
  EXPECT_EQ(BeSilent(150).set_points, 0);
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 200);
  EXPECT_FALSE(guard_.has_taken_over());
}

// Its BRAKE would let it sink on: it is stopped by set-points first.
TEST_F(FlightGuardTest, StopsAbandonedArduCopter) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  velocity_ = {0, -4.2, -1.4};
  EXPECT_EQ(BeSilent(170).set_points, 0);
  const Sent sent = BeSilent(1000);
  EXPECT_NEAR(sent.set_points, 48, 2);
  EXPECT_THAT(sent.modes, ::testing::IsEmpty());
  EXPECT_THAT(sent.text, HasSubstr("Kestrel hangs: stopping, then BRAKE"));
  EXPECT_TRUE(guard_.has_taken_over());
  velocity_ = {0, 0.1, 0.1};
  EXPECT_THAT(BeSilent(20).modes, ::testing::IsEmpty()) << "it is still led";
  EXPECT_THAT(BeSilent(1200).modes, ::testing::Contains(FlightMode::kHold));
}

// A path that follows with ArduCopter's jerk does not swing back: the braking ends as it began.
TEST_F(FlightGuardTest, BrakesToRestWithinJerkOfAutopilot) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  velocity_ = {0, -4.2, -1.4};
  BeSilent(195);
  Eigen::Vector3d before(0, 0, 0);
  Sent sent;
  for (int ms = 0; ms < 2600; ms += 20) {
    sent = BeSilent(20);
    EXPECT_LE(sent.stop.velocity.y(), 0);
    EXPECT_LE(sent.stop.velocity.z(), 0);
    EXPECT_LE(sent.stop.acceleration.y(), 3 + 1e-9);
    EXPECT_LE(sent.stop.acceleration.z(), 2 + 1e-9);
    const Eigen::Vector3d change = sent.stop.acceleration - before;
    EXPECT_LE(change.cwiseAbs().maxCoeff(), 0.3) << "m/s^2 in 0.02 s, at " << ms << " ms";
    before = sent.stop.acceleration;
  }
  EXPECT_EQ(sent.stop.velocity.norm(), 0);
  EXPECT_EQ(sent.stop.acceleration.norm(), 0);
}

TEST_F(FlightGuardTest, DoesNotBrakeAgainstOldVelocity) {
  guard_.TakeVelocity({3, 0, 0}, now_);
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 200);
  EXPECT_EQ(BeSilent(1000).stop.acceleration.norm(), 0);
}

TEST_F(FlightGuardTest, RequestsLoiterWhenBrakeIsRefused) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  guard_.TakeEnd();
  velocity_ = {0, 0, 0};
  EXPECT_THAT(BeSilent(100).modes, ::testing::ElementsAre(FlightMode::kHold));
  guard_.TakeRefusal();
  EXPECT_THAT(BeSilent(300).modes, ::testing::ElementsAre(FlightMode::kPilot));
}

TEST_F(FlightGuardTest, SwitchesPx4ToHoldOnlyOnceItStands) {
  Fly(GuardTask::kStop, AutopilotKind::kPx4, 100);
  guard_.TakeEnd();
  velocity_ = {4.2, 0, 0};
  const Sent moving = BeSilent(1500);
  EXPECT_THAT(moving.modes, ::testing::IsEmpty());
  EXPECT_NEAR(moving.set_points, 75, 2);
  EXPECT_EQ(moving.stop.acceleration.norm(), 0) << "it brakes hard enough by itself";
  velocity_ = {0.2, 0, 0};
  EXPECT_THAT(BeSilent(20).modes, ::testing::ElementsAre(FlightMode::kHold));
  EXPECT_EQ(BeSilent(200).set_points, 0);  // its answer may be late
  EXPECT_GT(BeSilent(200).set_points, 0);  // there was none
}

TEST_F(FlightGuardTest, SwitchesPx4ToHoldAfterTimeoutWithoutSpeed) {
  Fly(GuardTask::kStop, AutopilotKind::kPx4, 100);
  guard_.TakeEnd();
  EXPECT_THAT(BeSilent(2900).modes, ::testing::IsEmpty());
  EXPECT_THAT(BeSilent(200).modes, ::testing::ElementsAre(FlightMode::kHold));
}

// --- No position that lasts ---

TEST_F(FlightGuardTest, LevelsOnceAndLandsWithoutPosition) {
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    guard_ = FlightGuard(milliseconds(200));
    guard_.TakeHeading(0.7F);
    Fly(GuardTask::kLower, kind, 100);
    guard_.TakeEnd();
    velocity_ = {0, 0, 0};
    const Sent sent = BeSilent(1000);
    EXPECT_EQ(sent.set_points, 0);
    EXPECT_EQ(sent.levels, kind == AutopilotKind::kArduPilot ? 1 : 0);
    EXPECT_THAT(sent.modes, ::testing::Each(FlightMode::kLand));
    EXPECT_GE(sent.modes.size(), 3u);
    EXPECT_EQ(sent.text, "Kestrel is gone, no position: LAND\n");
  }
}

TEST_F(FlightGuardTest, GivesUavWithoutPositionToPilotWithSticks) {
  guard_.TakeReceiver(true);
  guard_.TakeThrottle(true, now_);
  Fly(GuardTask::kLower, AutopilotKind::kPx4, 100);
  const Sent sent = BeSilent(400);
  EXPECT_EQ(sent.modes.front(), FlightMode::kAltitude);
  EXPECT_EQ(sent.text, "Kestrel hangs, no position: fly by hand\n");
  guard_.TakeRefusal();
  EXPECT_THAT(BeSilent(300).modes, ::testing::ElementsAre(FlightMode::kLand));
}

// It would come down as fast as it may.
TEST_F(FlightGuardTest, DoesNotGiveUavToPilotWithThrottleDown) {
  guard_.TakeReceiver(true);
  guard_.TakeThrottle(true, now_);
  guard_.TakeThrottle(false, now_);
  Fly(GuardTask::kLower, AutopilotKind::kArduPilot, 100);
  EXPECT_THAT(BeSilent(600).modes, ::testing::Each(FlightMode::kLand));
}

TEST_F(FlightGuardTest, DoesNotGiveUavToLostTransmitter) {
  guard_.TakeThrottle(true, now_);
  guard_.TakeReceiver(false);
  Fly(GuardTask::kLower, AutopilotKind::kArduPilot, 100);
  EXPECT_THAT(BeSilent(600).modes, ::testing::Each(FlightMode::kLand));
}

TEST_F(FlightGuardTest, LandsUavOnDeckWithoutSetPoint) {
  for (const AutopilotKind kind : {AutopilotKind::kArduPilot, AutopilotKind::kPx4}) {
    guard_ = FlightGuard(milliseconds(200));
    Fly(GuardTask::kLand, kind, 100);
    const Sent sent = BeSilent(1000);
    EXPECT_EQ(sent.set_points, 0);
    EXPECT_THAT(sent.modes, ::testing::Each(FlightMode::kLand));
    EXPECT_GE(sent.modes.size(), 2u);
    EXPECT_THAT(sent.text, HasSubstr("LAND"));
  }
}

// PX4 goes back to OFFBOARD by itself when set-points come again.
TEST_F(FlightGuardTest, SendsNothingAfterPilotTookBack) {
  Fly(GuardTask::kStop, AutopilotKind::kPx4, 100);
  is_guided_ = false;
  const Sent sent = BeSilent(3000);
  EXPECT_EQ(sent.set_points, 0);
  EXPECT_THAT(sent.modes, ::testing::IsEmpty());
  EXPECT_THAT(sent.text, HasSubstr("the mode was left before"));
  EXPECT_TRUE(guard_.is_done());
}

TEST_F(FlightGuardTest, SendsNothingOnceModeIsLeftDuringItsWork) {
  Fly(GuardTask::kStop, AutopilotKind::kPx4, 100);
  EXPECT_GT(BeSilent(400).set_points, 5);
  is_guided_ = false;
  EXPECT_EQ(BeSilent(500).set_points, 0);
  EXPECT_FALSE(guard_.is_done());  // it listens for a moment
  is_guided_ = true;               // somebody gives the mode anew: that is not the guard's
  EXPECT_EQ(BeSilent(1000).set_points, 0);
  EXPECT_TRUE(guard_.is_done());
}

TEST_F(FlightGuardTest, LateProgramDoesNotRegainUav) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  BeSilent(400);
  guard_.TakeLife(GuardTask::kStop, AutopilotKind::kArduPilot, now_);
  EXPECT_GT(BeSilent(100).set_points, 3);
}

TEST_F(FlightGuardTest, EndsWithProgramThatDoesNotFly) {
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  Fly(GuardTask::kNothing, AutopilotKind::kArduPilot, 100);
  EXPECT_EQ(BeSilent(1000).text, "");  // it hangs, on the ground or while the pilot flies
  EXPECT_FALSE(guard_.is_done());
  guard_.TakeEnd();
  EXPECT_EQ(BeSilent(10).text, "");
  EXPECT_TRUE(guard_.is_done());
  EXPECT_FALSE(guard_.has_taken_over());
}

TEST_F(FlightGuardTest, EndsQuietlyAfterLanding) {
  Fly(GuardTask::kLand, AutopilotKind::kPx4, 100);
  guard_.TakeArmed(false);
  EXPECT_EQ(BeSilent(500).text, "");
  guard_.TakeEnd();
  EXPECT_EQ(BeSilent(10).text, "");
  EXPECT_TRUE(guard_.is_done());
  EXPECT_FALSE(guard_.has_taken_over());
}

TEST_F(FlightGuardTest, EndsWhenMotorsAreOffOrAutopilotIsGone) {
  Fly(GuardTask::kLand, AutopilotKind::kArduPilot, 100);
  guard_.TakeEnd();
  BeSilent(500);
  guard_.TakeArmed(false);
  EXPECT_THAT(BeSilent(100).modes, ::testing::IsEmpty());

  guard_ = FlightGuard(milliseconds(200));
  Fly(GuardTask::kStop, AutopilotKind::kArduPilot, 100);
  guard_.TakeEnd();
  for (int i = 0; i < 12'000; i += 20) {
    now_ += milliseconds(20);
    guard_.Update(now_);
  }
  EXPECT_TRUE(guard_.is_done());
}

}  // namespace
}  // namespace kestrel
