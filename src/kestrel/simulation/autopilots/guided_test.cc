// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/flight/guidance/stale_safety.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

AutopilotModelOptions Guided(const std::string& parameters = "", double guide_after_s = 1) {
  AutopilotModelOptions options;
  options.parameters = parameters;
  options.pilot.guide_after_s = guide_after_s;
  options.uav.wind.min_mps = options.uav.wind.max_mps = 0;
  return options;
}

class GuidedAutopilot : public TestAutopilot {
 public:
  GuidedAutopilot(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                  const std::string& path = "standing", double speed_mps = 0)
      : TestAutopilot(firmware, options, TestVehicle(path, speed_mps)),
        kind_(firmware == AutopilotFirmware::kPx4 ? AutopilotKind::kPx4
                                                  : AutopilotKind::kArduPilot) {}

  mavlink::SetPositionTargetLocalNed Message(const Vector3d& velocity) const {
    SetPoint set_point;
    set_point.velocity = velocity;
    return SetPointMessage(set_point, kind_, 1, 1, 0);
  }
  // Sends set-points of this velocity, 50 times per second.
  void Guide(double seconds, const Vector3d& velocity) {
    Run(seconds, [&] { Send(Message(velocity)); });
  }
  // Follows the pattern's centre and its acceleration with 'gain', 'height_m' above it.
  void Pursue(double seconds, double height_m, double gain, double sink_mps = 0) {
    Run(seconds, [&] {
      constexpr double kStep_s = 0.05;
      const Duration step = DurationFromSeconds(kStep_s);
      Vector3d way = world.PatternAt(now).translation - Position();
      way.z() += height_m;
      SetPoint set_point;
      set_point.velocity = world.VelocityAt(now) + gain * way;
      if (sink_mps > 0) set_point.velocity.z() = -sink_mps;
      set_point.acceleration =
          (world.VelocityAt(now + step) - world.VelocityAt(now - step)) / (2 * kStep_s);
      Send(SetPointMessage(set_point, kind_, 1, 1, 0));
    });
  }
  // Returns the RMS of the horizontal distance from the pattern during a while of Pursue.
  double TrailingRms(double seconds, double gain) {
    double sum = 0;
    int count = 0;
    while (count < std::lround(seconds / 0.1)) {
      Pursue(0.1, 10, gain);
      sum += HorizontalError() * HorizontalError();
      ++count;
    }
    return std::sqrt(sum / count);
  }

  bool is_guided() const { return IsGuidedMode(kind_, model.custom_mode()); }
  bool IsIn(FlightMode mode) const { return model.custom_mode() == CustomModeOf(kind_, mode); }
  Vector3d Position() const { return model.truth().world_from_body.translation; }
  Vector3d Velocity() const { return model.truth().motion->velocity_in_world; }
  std::uint8_t Command(std::uint16_t command, float p1, float p2, float p3 = 0) {
    mavlink::CommandLong message;
    message.target_system = 1;
    message.command = command;
    message.param1 = p1;
    message.param2 = p2;
    message.param3 = p3;
    Send(message);
    return Sent<mavlink::CommandAck>().back().result;
  }
  void EnterHold() {
    mavlink::SetMode message;
    message.target_system = 1;
    message.base_mode = mavlink::kModeFlagCustom;
    message.custom_mode = CustomModeOf(kind_, FlightMode::kHold);
    Send(message);
  }

 private:
  AutopilotKind kind_;
};

class GuidedTest : public testing::TestWithParam<AutopilotFirmware> {};
INSTANTIATE_TEST_SUITE_P(Both, GuidedTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(GuidedTest, FollowsSetPointsOncePilotSelectsMode) {
  GuidedAutopilot autopilot(GetParam(), Guided());
  autopilot.Guide(0.8, {3, 1, 0.5});
  EXPECT_FALSE(autopilot.is_guided());
  autopilot.Guide(8, {3, 1, 0.5});
  EXPECT_TRUE(autopilot.is_guided());
  EXPECT_LT((autopilot.Velocity() - Vector3d(3, 1, 0.5)).norm(), 0.15);
  EXPECT_GT(autopilot.model.result().set_points, 300);
  EXPECT_NEAR(autopilot.model.result().guided_s, 7.8, 0.3);
}

TEST_P(GuidedTest, TurnsToYaw) {
  GuidedAutopilot autopilot(GetParam(), Guided());
  autopilot.Run(8, [&] {
    auto message = autopilot.Message({0, 0, 0});
    message.type_mask = 0x807;
    message.yaw = 2;
    autopilot.Send(message);
  });
  const Vector3d nose = autopilot.model.truth().world_from_body.rotation * Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(nose.x(), nose.y()), 2, 0.02) << "clockwise from north";
}

// As the real ones do: the mode that holds bounds the jerk, so that the UAV goes on for a while.
TEST_P(GuidedTest, HoldModeStopsLate) {
  GuidedAutopilot autopilot(GetParam(), Guided());
  autopilot.Guide(6, {4, 0, -1.2});
  const Vector3d begin = autopilot.Position();
  autopilot.EnterHold();
  autopilot.Run(6, [] {});
  const Vector3d way = autopilot.Position() - begin;
  EXPECT_GT(way.x(), 2.5);
  EXPECT_LT(way.x(), 9);
  EXPECT_LT(way.z(), -0.4);
  EXPECT_GT(way.z(), -2);
  EXPECT_LT(autopilot.Velocity().norm(), 0.1);
}

TEST_P(GuidedTest, CountsSetPointsAfterPilotTookBack) {
  AutopilotModelOptions options = Guided();
  options.pilot.take_back_after_s = 5;
  GuidedAutopilot autopilot(GetParam(), options);
  autopilot.Guide(4.9, {1, 0, 0});
  EXPECT_TRUE(autopilot.is_guided());
  autopilot.Guide(0.3, {1, 0, 0});
  autopilot.Run(10);
  EXPECT_TRUE(autopilot.IsIn(FlightMode::kPilot));
  const SitlResult& result = autopilot.model.result();
  EXPECT_NEAR(result.set_points_after_take_back, 10, 2);
  EXPECT_NEAR(result.last_set_point_after_s, 0.2, 0.03);
  EXPECT_LT(autopilot.Velocity().norm(), 0.1);
  EXPECT_EQ(result.guided_entries, 1);
  EXPECT_THAT(InWords(result), testing::HasSubstr("set-points after the mode was left, the last"));
}

TEST_P(GuidedTest, LowBatteryEndsGuidedFlightForGood) {
  AutopilotModelOptions options = Guided();
  options.pilot.battery_failsafe_after_s = 4;
  GuidedAutopilot autopilot(GetParam(), options);
  autopilot.Guide(8, {1, 0, 0});
  EXPECT_TRUE(autopilot.IsIn(FlightMode::kReturn)) << "set-points go on";
  EXPECT_EQ(autopilot.Sent<mavlink::Heartbeat>().back().system_status, mavlink::kStateCritical);
  autopilot.Run(110);
  EXPECT_FALSE(autopilot.model.is_armed());
  EXPECT_LT(autopilot.Position().head<2>().norm(), 1) << "home";
}

TEST_P(GuidedTest, StopsMotorsOnDrivingDeckByForcedDisarm) {
  GuidedAutopilot autopilot(GetParam(), Guided(), "straight", 4.2);
  autopilot.Pursue(12, 3, 1.5);
  autopilot.Pursue(12, 0, 1.5, 0.6);
  ASSERT_TRUE(autopilot.model.result().contact);
  EXPECT_LT(autopilot.model.result().offset_m(), 0.5);
  EXPECT_TRUE(autopilot.model.is_armed()) << "PX4 does not know that it has landed";
  if (GetParam() == AutopilotFirmware::kPx4) {
    EXPECT_EQ(autopilot.Command(mavlink::kCommandArmDisarm, 0, 0), mavlink::kResultFailed);
  }
  EXPECT_EQ(autopilot.Command(mavlink::kCommandArmDisarm, 0, 21196), mavlink::kResultAccepted);
  EXPECT_FALSE(autopilot.model.is_armed());
  EXPECT_THAT(InWords(autopilot.model.result()), testing::HasSubstr("disarmed by force"));
}

TEST_P(GuidedTest, LandModeDisarmsOnStandingDeck) {
  GuidedAutopilot autopilot(GetParam(), Guided());
  autopilot.Pursue(8, 2, 1);
  autopilot.Pursue(5, 0, 1, 0.6);
  ASSERT_TRUE(autopilot.model.result().contact);
  const bool is_px4 = GetParam() == AutopilotFirmware::kPx4;
  EXPECT_EQ(autopilot.Command(mavlink::kCommandDoSetMode, 1, is_px4 ? 4 : 9, is_px4 ? 6 : 0),
            mavlink::kResultAccepted);
  autopilot.Run(8);
  EXPECT_FALSE(autopilot.model.is_armed());
  EXPECT_TRUE(autopilot.model.result().is_disarmed);
  EXPECT_EQ(autopilot.model.result().modes_by_link, 1);
}

TEST(ArduPilotGuidedTest, StopsWhenSetPointsEnd) {
  GuidedAutopilot autopilot(AutopilotFirmware::kArduPilot, Guided("GUID_TIMEOUT=1"));
  autopilot.Guide(6, {3, 0, 0});
  autopilot.Run(0.8);
  EXPECT_NEAR(autopilot.Velocity().x(), 3, 0.1);
  autopilot.Run(4);
  EXPECT_LT(autopilot.Velocity().norm(), 0.1);
  EXPECT_TRUE(autopilot.is_guided());
  autopilot.Guide(4, {3, 0, 0});
  EXPECT_NEAR(autopilot.Velocity().x(), 3, 0.1);
}

TEST(ArduPilotGuidedTest, KeepsItsLimits) {
  GuidedAutopilot autopilot(AutopilotFirmware::kArduPilot, Guided());
  autopilot.Guide(1.02, {0, 0, 0});
  double speed = 0;
  for (int i = 0; i < 100; ++i) {
    autopilot.Guide(0.02, {8, 0, 0});
    EXPECT_LT(autopilot.Velocity().x() - speed, 0.02 * 3.5) << "WP_ACC is 2.5";
    speed = autopilot.Velocity().x();
  }
}

TEST(ArduPilotGuidedTest, StopsOnUnsupportedSetPoints) {
  const auto speed_by = [](auto&& change) {
    GuidedAutopilot autopilot(AutopilotFirmware::kArduPilot, Guided());
    autopilot.Guide(5, {2, 0, 0});
    autopilot.Run(5, [&] {
      auto message = autopilot.Message({2, 0, 0});
      change(&message);
      autopilot.Send(message);
    });
    return autopilot.Velocity().norm();
  };
  EXPECT_NEAR(speed_by([](auto*) {}), 2, 0.1);
  EXPECT_NEAR(speed_by([](auto* m) { m->coordinate_frame = mavlink::kFrameBodyNed; }), 2, 0.1);
  EXPECT_LT(speed_by([](auto* m) { m->coordinate_frame = mavlink::kFrameBodyFrd; }), 0.1);
  EXPECT_LT(speed_by([](auto* m) { m->coordinate_frame = mavlink::kFrameLocalFrd; }), 0.1);
  EXPECT_LT(speed_by([](auto* m) { m->type_mask = 0xfff; }), 0.1);
  EXPECT_LT(speed_by([](auto* m) { m->type_mask |= 8; }), 0.1) << "one axis drops all";
  EXPECT_LT(speed_by([](auto* m) { m->vx = std::nanf(""); }), 0.1);
  EXPECT_LT(speed_by([](auto* m) { m->vx = 2000; }), 0.1);
}

TEST(ArduPilotGuidedTest, FollowsDrivingDeckAndDisarmsAfterDelay) {
  GuidedAutopilot autopilot(AutopilotFirmware::kArduPilot, Guided(), "straight", 4.2);
  autopilot.Pursue(12, 3, 1.5);
  EXPECT_LT(autopilot.HorizontalError(), 0.2);
  autopilot.Pursue(10, 0, 1.5, 0.6);
  ASSERT_TRUE(autopilot.model.result().contact);
  EXPECT_TRUE(autopilot.model.is_armed());
  autopilot.Pursue(12, 0, 1.5, 0.6);
  EXPECT_FALSE(autopilot.model.is_armed()) << "DISARM_DELAY is 10";
}

// Velocities do not lift it off once it has landed.
TEST(ArduPilotGuidedTest, DoesNotLiftOffByVelocities) {
  GuidedAutopilot autopilot(AutopilotFirmware::kArduPilot, Guided());
  autopilot.Pursue(8, 2, 1);
  autopilot.Pursue(9, 0, 1, 0.6);
  ASSERT_TRUE(autopilot.model.result().contact);
  const double height = autopilot.Position().z();
  autopilot.Guide(3, {0, 0, 2});
  EXPECT_NEAR(autopilot.Position().z(), height, 0.05);
}

TEST(Px4OffboardTest, RequiresStreamOfSetPointsFirst) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided("", -1));
  const auto request = [&] { return autopilot.Command(mavlink::kCommandDoSetMode, 1, 6); };
  EXPECT_EQ(request(), mavlink::kResultTemporarilyRejected);
  autopilot.Guide(0.4, {0, 0, 0});
  EXPECT_EQ(request(), mavlink::kResultTemporarilyRejected);
  for (int i = 0; i < 4; ++i) {
    autopilot.Run(0.6);
    autopilot.Send(autopilot.Message({0, 0, 0}));
  }
  EXPECT_EQ(request(), mavlink::kResultTemporarilyRejected) << "slower than 2 Hz";
  autopilot.Guide(0.8, {0, 0, 0});
  EXPECT_EQ(request(), mavlink::kResultAccepted);
  EXPECT_TRUE(autopilot.is_guided());
}

TEST(Px4OffboardTest, PilotRetriesUntilAccepted) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided());
  autopilot.Run(5);
  EXPECT_FALSE(autopilot.is_guided());
  autopilot.Guide(1.5, {0, 0, 0});
  EXPECT_TRUE(autopilot.is_guided());
}

TEST(Px4OffboardTest, DropsOtherFrames) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided());
  autopilot.Send(mavlink::Heartbeat{.type = mavlink::kTypeGcs});
  autopilot.Run(4, [&] {
    auto message = autopilot.Message({0, 0, 0});
    message.coordinate_frame = mavlink::kFrameLocalOffsetNed;
    autopilot.Send(message);
  });
  EXPECT_FALSE(autopilot.is_guided());
  EXPECT_GT(autopilot.CountText("SET_POSITION_TARGET_LOCAL_NED coordinate frame"), 100);
}

TEST(Px4OffboardTest, FollowsParametersWhenSetPointsEnd) {
  const auto mode_after = [](const std::string& parameters, double seconds) {
    GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided(parameters));
    autopilot.Guide(4, {2, 0, 0});
    EXPECT_TRUE(autopilot.is_guided());
    autopilot.Run(seconds);
    return autopilot.model.custom_mode();
  };
  const auto number = [](FlightMode mode) { return CustomModeOf(AutopilotKind::kPx4, mode); };
  EXPECT_EQ(mode_after("", 1.1), number(FlightMode::kGuided));
  EXPECT_EQ(mode_after("", 1.5), number(FlightMode::kHold));
  EXPECT_EQ(mode_after("COM_OF_LOSS_T=0.2", 0.7), number(FlightMode::kHold));
  EXPECT_EQ(mode_after("COM_OBL_RC_ACT=4", 1.5), number(FlightMode::kLand));
  EXPECT_EQ(mode_after("COM_OBL_RC_ACT=0", 1.5), number(FlightMode::kReturn));
  EXPECT_EQ(mode_after("COM_OBL_RC_ACT=0,NAV_RCL_ACT=1", 1.5), number(FlightMode::kHold));
  EXPECT_EQ(mode_after("COM_OBL_RC_ACT=0,NAV_RCL_ACT=0", 20), number(FlightMode::kGuided));
}

TEST(Px4OffboardTest, KeepsFlyingWithoutFailsafe) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided("COM_OBL_RC_ACT=0,NAV_RCL_ACT=0"));
  autopilot.Guide(4, {2, 0, 0});
  autopilot.Run(20);
  EXPECT_NEAR(autopilot.Velocity().x(), 2, 0.1);
}

// On the way to a place it flies as if it were given the velocity, and stops there when nothing
// follows: 4.2 m/s / MPC_XY_P.
TEST(Px4OffboardTest, StopsAtSetPointPlace) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided("COM_OBL_RC_ACT=0,NAV_RCL_ACT=0"));
  const StaleSafety safety({.position_gain = 0.95, .height_gain = 1});
  SetPoint last;
  autopilot.Run(6, [&] {
    last = {.velocity = {4.2, 0, 0}};
    if (autopilot.Position().z() > 6) last.velocity.z() = -0.5;
    safety.SetPlace(autopilot.Position(), autopilot.Velocity(), 0, &last);
    autopilot.Send(SetPointMessage(last, AutopilotKind::kPx4, 1, 1, 0));
  });
  EXPECT_NEAR(autopilot.Velocity().x(), 4.2, 0.2);
  const Vector3d where = autopilot.Position();
  double farthest = 0, lowest = where.z();
  for (int i = 0; i < 200; ++i) {
    autopilot.Run(0.1);
    farthest = std::max(farthest, (autopilot.Position() - where).head<2>().norm());
    lowest = std::min(lowest, autopilot.Position().z());
  }
  EXPECT_LT(autopilot.Velocity().norm(), 0.1);
  EXPECT_LT((autopilot.Position() - *last.place).norm(), 0.2);
  EXPECT_LT(farthest, 5.2);
  EXPECT_GT(lowest, where.z() - 0.6);
}

TEST(Px4OffboardTest, ReentersModeWhenSetPointsReturn) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided("COM_OBL_RC_ACT=4"));
  autopilot.Guide(4, {0, 0, 0});
  autopilot.Run(3);
  ASSERT_TRUE(autopilot.IsIn(FlightMode::kLand));
  autopilot.Guide(1, {0, 0, 1});
  EXPECT_TRUE(autopilot.is_guided());
  EXPECT_EQ(autopilot.model.result().guided_entries, 2);
  AutopilotModelOptions options = Guided("COM_OBL_RC_ACT=4");
  options.pilot.take_back_after_s = 8;
  GuidedAutopilot taken(AutopilotFirmware::kPx4, options);
  taken.Guide(4, {0, 0, 0});
  taken.Run(5);
  taken.Guide(3, {0, 0, 1});
  EXPECT_TRUE(taken.IsIn(FlightMode::kPilot)) << "not after the pilot took it";
}

TEST(Px4OffboardTest, ClipsVelocities) {
  GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided("MPC_XY_VEL_MAX=4"));
  autopilot.Guide(10, {9, 0, 5});
  EXPECT_NEAR(autopilot.Velocity().x(), 4, 0.3);
  EXPECT_NEAR(autopilot.Velocity().z(), 3, 0.2);
  autopilot.Guide(6, {0, 0, -5});
  EXPECT_NEAR(autopilot.Velocity().z(), -1.5, 0.2);
}

// Measured with the real one in SIH, with its drag and a quarter of it, on a circle of 8 m: 2.1 and
// 0.54 m with a gain of 1, 1.1 and 0.27 m with 2; straight 0.08 and 0.03 m.
TEST(Px4OffboardTest, TrailsOnCurveByDrag) {
  const auto trails_by = [](const std::string& path, double drag, double gain) {
    AutopilotModelOptions options = Guided();
    options.uav.multicopter.drag = drag;
    GuidedAutopilot autopilot(AutopilotFirmware::kPx4, options, path, 4.2);
    autopilot.Pursue(20, 10, gain);
    return autopilot.TrailingRms(15, gain);
  };
  const double much = trails_by("circle", 1, 1);
  const double little = trails_by("circle", 0.25, 1);
  const double with_gain = trails_by("circle", 1, 2);
  const double straight = trails_by("straight", 1, 1);
  RecordProperty("figures", fmt::format("{} {} {} {}", much, little, with_gain, straight));
  EXPECT_GT(much, 0.8);
  EXPECT_LT(much, 2.5);
  EXPECT_GT(little, 0.2);
  EXPECT_LT(little, 0.6 * much);
  EXPECT_LT(with_gain, 0.7 * much);
  EXPECT_LT(straight, 0.3);
}

TEST(Px4OffboardTest, DisarmsOnDrivingDeckBySpeedOfLandDetector) {
  for (const bool raised : {false, true}) {
    GuidedAutopilot autopilot(AutopilotFirmware::kPx4, Guided(raised ? "LNDMC_XY_VEL_MAX=5" : ""),
                              "straight", 4.2);
    autopilot.Pursue(12, 3, 1.5);
    autopilot.Pursue(15, 0, 1.5, 0.6);
    ASSERT_TRUE(autopilot.model.result().contact);
    EXPECT_EQ(autopilot.model.is_armed(), !raised);
    if (raised) {
      EXPECT_GT(autopilot.model.result().disarm_s, 3.9);
      EXPECT_LT(autopilot.model.result().disarm_s, 6.5);
    }
  }
}

TEST(EstimateFaultsTest, InjectsFaultsByOptions) {
  AutopilotModelOptions options = Guided("", -1);
  options.pilot.land_after_s = -1;
  options.vehicle_type = 1;
  options.estimate.silent_after_s = 1;
  options.estimate.silent_for_s = 2;
  options.estimate.jump_after_s = 4;
  options.estimate.lost_after_s = 6;
  options.estimate.has_home = false;
  TestAutopilot autopilot(AutopilotFirmware::kPx4, options, TestVehicle("standing", 0));
  const auto come = [&](double seconds) {
    autopilot.sent.clear();
    autopilot.Run(seconds);
    return autopilot.Sent<mavlink::LocalPositionNed>().size();
  };
  EXPECT_GT(come(0.9), 20u);
  come(0.2);
  EXPECT_EQ(come(1.8), 0u);
  EXPECT_GT(come(1), 20u);
  const float before = autopilot.Sent<mavlink::LocalPositionNed>().back().y;
  EXPECT_GT(come(1), 20u);
  EXPECT_NEAR(autopilot.Sent<mavlink::LocalPositionNed>().back().y, before + 5, 0.2);
  EXPECT_LT(autopilot.HorizontalError(), 2.5) << "it does not fly there";
  come(1.2);
  EXPECT_EQ(come(3), 0u);
  EXPECT_EQ(autopilot.Sent<mavlink::EstimatorStatus>().back().flags & 16, 0);
  EXPECT_EQ(autopilot.Sent<mavlink::Heartbeat>().back().type, 1);
  EXPECT_TRUE(autopilot.Sent<mavlink::HomePosition>().empty());
}

}  // namespace
}  // namespace kestrel
