// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/landing_watch.h"

#include <chrono>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono_literals::operator""ms;
using ::testing::HasSubstr;

constexpr double kRadius_m = 0.5;

// A UAV over a pattern at the origin; time is simulated, in steps of 20 ms.
class LandingWatchTest : public ::testing::Test {
 protected:
  void Pass(double seconds, double climb_mps = 0) {
    for (int i = 0; i < 50 * seconds; ++i) {
      input_.now += 20ms;
      if (stamps_) input_.stamped = input_.now;
      if (input_.body) {
        input_.body->velocity.z() = climb_mps;
        input_.body->feet.z() += 0.02 * climb_mps;
      }
      watch_.Observe(input_);
    }
  }
  void SeePattern(double sigma_m) {
    input_.pattern = {Eigen::Vector3d::Zero(), sigma_m * sigma_m * Eigen::Matrix3d::Identity()};
  }
  // Flies beside the centre by 'offset_m', and sinks to the pattern's height.
  void ComeDown(double offset_m, double sigma_m = 0.02) {
    input_.is_armed = true;
    input_.state = LandedState::kInAir;
    input_.body = {{offset_m, 0, 2}, Eigen::Vector3d::Zero()};
    SeePattern(sigma_m);
    Pass(1);
    Pass(4, -0.5);
    Pass(1);
  }
  void Disarm() {
    input_.is_armed = false;
    input_.state = LandedState::kOnGround;
    Pass(1);
  }

  LandingWatchInput input_{.now = TimeFromNanoseconds(1'000'000'000'000),
                           .stamped = {},
                           .body = {},
                           .pattern = {},
                           .sight = {},
                           .gave_up = {}};
  bool stamps_ = true;
  LandingWatch watch_{kRadius_m};
};

TEST_F(LandingWatchTest, ReportsOffsetOfLandingOnPattern) {
  ComeDown(0.12);
  EXPECT_FALSE(watch_.end());
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
  EXPECT_NEAR(*watch_.end()->offset_m, 0.12, 1e-6);
}

TEST_F(LandingWatchTest, ReportsHeadingAtTouchDown) {
  input_.heading_error = -0.02;
  ComeDown(0.12);
  input_.heading_error = 1;
  Disarm();
  EXPECT_EQ(InWords(*watch_.end()),
            "landed 0.12 m from the centre (estimated), heading off by -1.1 degrees");
}

TEST_F(LandingWatchTest, ReportsLandingBesidePattern) {
  ComeDown(10.8, 1.5);
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(InWords(*watch_.end()), "landed 10.8 m beside the pattern (estimated)");
}

// The pattern drives on below a UAV that stands beside it, and is not seen any more.
TEST_F(LandingWatchTest, JudgesAtTouchDown) {
  ComeDown(0.2);
  input_.pattern->position = {30, 0, 0};
  input_.pattern->covariance *= 1e6;
  Pass(5);
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
}

TEST_F(LandingWatchTest, IgnoresHeaveAfterContact) {
  ComeDown(0.2);
  input_.has_contact = true;
  input_.pattern.reset();
  Pass(3, 0.5);
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
}

TEST_F(LandingWatchTest, ReportsUnknownPlaceOfUncertainLanding) {
  ComeDown(1.2, 0.9);  // on it or beside it
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kDownSomewhere);
  EXPECT_FALSE(watch_.end()->offset_m);
}

TEST_F(LandingWatchTest, ReportsUnknownPlaceWhenPatternWasLostBefore) {
  input_.is_armed = true;
  input_.state = LandedState::kInAir;
  input_.body = {{3.1, 0, 5}, Eigen::Vector3d::Zero()};
  SeePattern(0.02);
  Pass(2, -0.5);
  input_.pattern.reset();
  Pass(8, -0.5);
  Disarm();
  EXPECT_EQ(InWords(*watch_.end()),
            "down, and not known where: 8 s before touch-down the pattern was 3.1 m away, and then "
            "lost");
}

TEST_F(LandingWatchTest, ReportsPatternNeverSeen) {
  input_.is_armed = true;
  input_.state = LandedState::kInAir;
  input_.body = {{0, 0, 2}, Eigen::Vector3d::Zero()};
  Pass(4, -0.5);
  Disarm();
  EXPECT_THAT(InWords(*watch_.end()), HasSubstr("never seen"));
}

TEST_F(LandingWatchTest, ReportsWherePatternWasSeenWithoutPosition) {
  input_.is_armed = true;
  input_.state = LandedState::kInAir;
  input_.sight = {input_.now, {3, 0, 2}};
  Pass(4);
  Disarm();
  EXPECT_THAT(InWords(*watch_.end()), HasSubstr("the pattern was last seen 3.0 m away"));
}

// Comes down to 'height_m' in sight of the pattern, and then without a position.
TEST_F(LandingWatchTest, UsesLastSightWhenPositionIsLost) {
  const struct {
    double offset_m, height_m;
    const char* words;
  } cases[] = {{0.03, 0.2,
                "landed 0.03 m from the centre (estimated), by what was seen: the autopilot had no "
                "position"},
               {0.03, 0.8, "guidance gave up (the poses have stopped); down, and not known where"},
               {0.7, 0.2, "guidance gave up (the poses have stopped); down, and not known where"}};
  for (const auto& [offset_m, height_m, words] : cases) {
    watch_ = LandingWatch(kRadius_m);
    input_.is_armed = true;
    input_.state = LandedState::kInAir;
    input_.body = {{0, 0, 4}, Eigen::Vector3d::Zero()};
    input_.pattern.reset();
    Pass(1, -0.5);
    input_.gave_up = "the poses have stopped";
    input_.body.reset();
    input_.sight = {input_.now, {offset_m, 0, height_m}};
    Pass(4);
    Disarm();
    ASSERT_TRUE(watch_.end());
    EXPECT_EQ(InWords(*watch_.end()), words);
  }
}

TEST_F(LandingWatchTest, IgnoresJumpingPosition) {
  ComeDown(0.1);
  input_.sight = {input_.now, {0.1, 0, 0.2}};
  input_.body->feet.x() += 6;
  Pass(0.3, -0.5);
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(InWords(*watch_.end()),
            "landed 0.10 m from the centre (estimated), by what was seen: the autopilot's position "
            "is wrong");
}

// PX4's height without GNSS runs away by metres, on the ground as well.
TEST_F(LandingWatchTest, IgnoresDriftingHeight) {
  ComeDown(0.1);
  input_.sight = {input_.now, {0.1, 0, 0.2}};
  Pass(1, -0.5);
  input_.state = LandedState::kOnGround;
  Pass(4, -0.5);
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_THAT(InWords(*watch_.end()), HasSubstr("landed 0.10 m from the centre (estimated), by "));
}

TEST_F(LandingWatchTest, DetectsLandingBesideDepartedPattern) {
  ComeDown(0.1);
  input_.sight = {input_.now, {0.1, 0, 0.4}};
  input_.body->feet.x() += 2;
  Pass(2, -0.2001);
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kBesidePattern);
}

TEST_F(LandingWatchTest, IgnoresOldSightOfPattern) {
  ComeDown(0.1);
  input_.sight = {input_.now, {0.1, 0, 0.4}};
  input_.pattern->covariance *= 1e6;
  Pass(10, -0.2001);
  Disarm();
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kDownSomewhere);
}

TEST_F(LandingWatchTest, DisarmingHighAbovePatternIsNoLanding) {
  input_.is_armed = true;
  input_.state = LandedState::kInAir;
  input_.body = {{0, 0, 5}, Eigen::Vector3d::Zero()};
  SeePattern(0.02);
  Pass(2, -0.5);
  Disarm();
  EXPECT_THAT(InWords(*watch_.end()), HasSubstr("disarmed 4.0 m above"));
}

TEST_F(LandingWatchTest, ReportsReasonOfGivingUpUnlessLandedOnPattern) {
  input_.gave_up = "no new images";
  ComeDown(3);
  Disarm();
  EXPECT_EQ(InWords(*watch_.end()),
            "guidance gave up (no new images); down 3.0 m from the pattern (estimated)");
  watch_ = LandingWatch(kRadius_m);
  ComeDown(0.1);
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
}

// The first heartbeat after a restart says "disarmed"; the new stamps come later.
TEST_F(LandingWatchTest, RestartOfAutopilotIsNoLanding) {
  ComeDown(0.1);
  stamps_ = false;
  Disarm();
  EXPECT_FALSE(watch_.end()) << "too early to tell";
  Pass(2);
  input_.reboots = 1;
  Pass(0.1);
  ASSERT_TRUE(watch_.end());
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kRestarted);
}

TEST_F(LandingWatchTest, IgnoresRestartOnGround) {
  input_.reboots = 1;
  Pass(1);
  ComeDown(0.1);
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
}

TEST_F(LandingWatchTest, EndsEventuallyWithoutStamps) {
  ComeDown(0.1);
  stamps_ = false;
  Disarm();
  Pass(11);
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kOnPattern);
}

TEST_F(LandingWatchTest, ArmingAndDisarmingOnGroundIsNoFlight) {
  input_.is_armed = true;
  input_.state = LandedState::kOnGround;
  input_.body = {{0, 0, 0}, Eigen::Vector3d::Zero()};
  Pass(2, 0.1);
  Disarm();
  Pass(20);
  EXPECT_FALSE(watch_.end());
}

TEST_F(LandingWatchTest, DetectsFlightByHeightWithoutLandedState) {
  input_.is_armed = true;
  input_.body = {{0, 0, 10}, Eigen::Vector3d::Zero()};
  SeePattern(0.02);
  Pass(20, -0.5);
  Disarm();
  ASSERT_TRUE(watch_.end());
}

TEST_F(LandingWatchTest, ReportsPlainLandingWithoutPattern) {
  watch_ = LandingWatch(0);
  ComeDown(4);
  Disarm();
  EXPECT_EQ(watch_.end()->outcome, FlightOutcome::kLanded);
}

}  // namespace
}  // namespace kestrel
