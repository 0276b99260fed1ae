// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/test_autopilot.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

constexpr std::uint32_t kArduCopterLandMode = 9;

TEST_F(AutopilotTest, IsFoundByItsHeartbeat) {
  Start();
  SendMessage(mavlink::Heartbeat{mavlink::kTypeGcs, 8, 0, 0, 4, 3}, 255, 190);
  Pass(1, false);
  EXPECT_EQ(autopilot_->kind(), AutopilotKind::kUnknown);
  SendHeartbeat();
  EXPECT_EQ(autopilot_->kind(), AutopilotKind::kArduPilot);
  EXPECT_EQ(autopilot_->mode_name(), "GUIDED");
  EXPECT_TRUE(autopilot_->is_armed());
  EXPECT_EQ(TextOfEvent(AutopilotEventKind::kHeard), "ArduPilot (system 1) heard, GUIDED, armed");
  SendHeartbeat(mavlink::kAutopilotArduPilot, kArduCopterLandMode);
  EXPECT_TRUE(autopilot_->is_landing_mode());
  EXPECT_EQ(TextOfEvent(AutopilotEventKind::kModeChanged), "mode LAND, armed");
}

TEST_F(AutopilotTest, SendsHeartbeatPerSecondFromStart) {
  Start();
  Pass(10, false);
  EXPECT_EQ(heard_[0], 10);
  const auto heartbeat = last_heard_[0].As<mavlink::Heartbeat>();
  EXPECT_EQ(heartbeat->type, mavlink::kTypeOnboardController);
  EXPECT_EQ(heartbeat->autopilot, mavlink::kAutopilotInvalid);
  EXPECT_EQ(last_heard_[0].component, 191);
}

TEST_F(AutopilotTest, TakesSystemIdOfAutopilot) {
  Start();
  SendMessage(mavlink::Heartbeat{2, 3, 0, 0, 4, 3}, 42, 1);
  EXPECT_EQ(autopilot_->system(), 42);
  EXPECT_EQ(connection_->system(), 42);
}

TEST_F(AutopilotTest, ReportsPosesInKestrelFrames) {
  Start();
  Pass(1);
  SendPose();
  ASSERT_EQ(poses_.size(), 1u);
  const PoseSample& pose = poses_[0];
  // 0.1 s after the position, at 2 m/s.
  EXPECT_TRUE(pose.world_from_body.translation.isApprox(Eigen::Vector3d(1.2, 3, 5), 1e-6));
  // The nose looks east, which is x of the world.
  EXPECT_TRUE((pose.world_from_body.rotation * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitX(), 1e-6));
  EXPECT_TRUE((pose.world_from_body.rotation * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitZ(), 1e-6));
  ASSERT_TRUE(pose.motion);
  EXPECT_TRUE(pose.motion->velocity_in_world.isApprox(Eigen::Vector3d(2, 0, 0), 1e-6));
  EXPECT_TRUE(pose.motion->rate_in_body.isApprox(Eigen::Vector3d(0.1, -0.2, -0.3), 1e-6));
  EXPECT_NEAR(ToSeconds(pose.time - now_), 0.1, 0.002);
}

TEST_F(AutopilotTest, UsesEulerAnglesWithoutQuaternions) {
  Start();
  Pass(1);
  SendPose();
  mavlink::Attitude attitude;
  attitude.time_boot_ms = BootMs() + 200;
  attitude.yaw = static_cast<float>(M_PI / 2);
  attitude.pitch = 0.3f;
  SendMessage(attitude);
  EXPECT_EQ(poses_.size(), 1u);  // quaternions come
  attitude.time_boot_ms = BootMs() + 700;
  SendMessage(attitude);
  EXPECT_EQ(poses_.size(), 1u);  // the position is too old by now
  now_ += milliseconds(700);
  SendPose();
  poses_.clear();
  now_ += milliseconds(200);
  attitude.time_boot_ms = BootMs() + 600;
  SendPose();
  attitude.time_boot_ms = BootMs() + 350;
  SendMessage(attitude);
  EXPECT_EQ(autopilot_->counters().without_position, 1u);
  // The attitude counts without a position, too.
  EXPECT_EQ(attitudes_.size(), 4u);
}

TEST_F(AutopilotTest, RequestsStreamsAndRenewsLostOnes) {
  Start();
  Pass(1);
  EXPECT_EQ(intervals_us_[mavlink::AttitudeQuaternion::kId], 10000);
  EXPECT_EQ(intervals_us_[mavlink::LocalPositionNed::kId], 20000);
  EXPECT_EQ(intervals_us_[mavlink::ExtendedSysState::kId], 200000);
  const auto request_count = [&] {
    intervals_us_.clear();
    for (int i = 0; i < 300; ++i) {
      Pass(0.01, i % 100 == 0);
      SendMessage(AttitudeAt(BootMs()));
    }
    return intervals_us_.count(mavlink::AttitudeQuaternion::kId);
  };
  request_count();
  EXPECT_EQ(request_count(), 0u);  // it comes already
  Pass(7);
  EXPECT_EQ(intervals_us_.count(mavlink::AttitudeQuaternion::kId), 1u);
}

TEST_F(AutopilotTest, RequestsStreamsOfOlderAutopilotsByOldMessage) {
  Start();
  Pass(5);
  EXPECT_GT(heard_[mavlink::RequestDataStream::kId], 0);
  EXPECT_EQ(intervals_us_[mavlink::Attitude::kId], 10000);
  Pass(20);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kSlowStream), 1);
}

TEST_F(AutopilotTest, ReportsMissingPosition) {
  Start();
  for (int i = 0; i < 2500; ++i) {
    Pass(0.01, i % 100 == 0);
    SendMessage(AttitudeAt(BootMs()));
  }
  EXPECT_EQ(EventsOf(AutopilotEventKind::kSlowStream), 0);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kNoPosition), 1);
  EXPECT_THAT(TextOfEvent(AutopilotEventKind::kNoPosition), HasSubstr("has no origin"));
  // The position follows the origin after a while: the line is not too slow.
  SendMessage(mavlink::GpsGlobalOrigin{-353632621, 1491652374, 584000});
  for (int i = 0; i < 2500; ++i) {
    Pass(0.01, i % 100 == 0);
    SendMessage(AttitudeAt(BootMs()));
  }
  EXPECT_EQ(EventsOf(AutopilotEventKind::kSlowStream), 0);
}

// The position begins between two of the requests, which come every 5 s by then.
TEST_F(AutopilotTest, DoesNotReportNewPositionStreamAsSlow) {
  for (int tenths = 0; tenths < 50; tenths += 3) {
    Start();
    events_.clear();
    for (int i = 0; i < 2000 + 10 * tenths; ++i) {
      Pass(0.01, i % 100 == 0);
      SendMessage(AttitudeAt(BootMs()));
    }
    for (int i = 0; i < 1000; ++i) {
      Pass(0.01, i % 100 == 0);
      if (i % 2 == 0) SendPose();
      if (i == 0) SendPose();  // one packet holds several messages
    }
    EXPECT_EQ(EventsOf(AutopilotEventKind::kNoPosition), 1);
    EXPECT_EQ(EventsOf(AutopilotEventKind::kSlowStream), 0) << tenths;
  }
}

TEST_F(AutopilotTest, ReportsFailsafe) {
  Start();
  SendMessage(
      mavlink::Heartbeat{mavlink::kTypeQuadrotor, kind_, 0, mode_, mavlink::kStateCritical, 3});
  EXPECT_EQ(TextOfEvent(AutopilotEventKind::kFailsafe),
            "the autopilot is in a failsafe (mode GUIDED)");
  EXPECT_THAT(FailsafeInWords(AutopilotKind::kPx4, 335806464), HasSubstr("(mode DESCEND)"));
  EXPECT_THAT(FailsafeInWords(AutopilotKind::kPx4, 12), HasSubstr("(mode #12)"));
}

TEST_F(AutopilotTest, SynchronisesPx4ClockFast) {
  kind_ = mavlink::kAutopilotPx4;
  Start();
  Pass(1);
  EXPECT_EQ(intervals_us_[mavlink::Timesync::kId], 10000);
  heard_.clear();
  for (int i = 0; i < 700; ++i) {
    mavlink::Timesync question;
    question.ts1 = RemoteAt(now_);
    SendMessage(question);
    Pass(0.01, i % 100 == 0);
  }
  EXPECT_GE(heard_[mavlink::Timesync::kId], 700);
  EXPECT_EQ(intervals_us_[mavlink::Timesync::kId], 100000);
}

TEST_F(AutopilotTest, AnswersTimesyncByAutopilotClock) {
  Start();
  Pass(2);
  mavlink::Timesync question;
  question.ts1 = RemoteAt(now_ - milliseconds(2));
  SendMessage(question);
  const auto answer = last_heard_[mavlink::Timesync::kId].As<mavlink::Timesync>();
  EXPECT_EQ(answer->ts1, question.ts1);
  EXPECT_NEAR(answer->tc1, RemoteAt(now_), 1e5);
  EXPECT_EQ(answer->target_system, 1);
}

TEST_F(AutopilotTest, EstimatesClockRoughlyWithoutTimesync) {
  answers_timesync_ = false;
  Start();
  for (int i = 0; i < 800; ++i) {
    Pass(0.01, i % 100 == 0);
    if (i % 2 == 0) SendPose();
  }
  EXPECT_GT(poses_.size(), 100u);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kNoTimeSync), 1);
}

TEST_F(AutopilotTest, DetectsReboot) {
  Start();
  Pass(3);
  SendPose();
  boot_ = now_ - milliseconds(1500);
  Pass(1);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kRestarted), 1);
  EXPECT_EQ(autopilot_->restarts(), 1);
  Pass(1);
  poses_.clear();
  SendPose();
  ASSERT_EQ(poses_.size(), 1u);
  EXPECT_NEAR(ToSeconds(poses_[0].time - now_), 0.1, 0.002);
  EXPECT_EQ(autopilot_->restarts(), 1);
  EXPECT_EQ(autopilot_->reboots(), 1);
}

TEST_F(AutopilotTest, ClockSetBackIsNoReboot) {
  Start();
  Pass(3);
  SendPose();
  boot_ += std::chrono::seconds(20);
  for (int i = 0; i < 5; ++i) {
    now_ += milliseconds(20);
    SendPose();
  }
  EXPECT_EQ(autopilot_->restarts(), 1);
  EXPECT_EQ(autopilot_->reboots(), 0);
}

TEST_F(AutopilotTest, DetectsRebootByTimestamps) {
  Start();
  Pass(3);
  SendPose();
  answers_timesync_ = false;
  boot_ = now_ - milliseconds(1500);
  for (int i = 0; i < 5; ++i) {
    now_ += milliseconds(20);
    SendPose();
  }
  EXPECT_EQ(autopilot_->restarts(), 1);
  EXPECT_EQ(autopilot_->reboots(), 1);
}

TEST_F(AutopilotTest, IgnoresOldMessage) {
  Start();
  Pass(1);
  SendPose();
  poses_.clear();
  SendMessage(AttitudeAt(BootMs() - 500));
  SendMessage(AttitudeAt(BootMs() - 50000));
  EXPECT_TRUE(poses_.empty());
  EXPECT_EQ(autopilot_->counters().backwards, 2u);
  EXPECT_THAT(TextOfEvent(AutopilotEventKind::kTimeBackwards),
              HasSubstr("older than the one before"));
  EXPECT_EQ(EventsOf(AutopilotEventKind::kTimeBackwards), 1);
  EXPECT_EQ(autopilot_->restarts(), 0);
}

TEST_F(AutopilotTest, IgnoresNonFiniteValues) {
  Start();
  Pass(1);
  SendPose();
  poses_.clear();
  mavlink::AttitudeQuaternion attitude = AttitudeAt(BootMs() + 120);
  attitude.q2 = std::numeric_limits<float>::quiet_NaN();
  SendMessage(attitude);
  mavlink::Attitude euler;
  euler.time_boot_ms = BootMs() + 130;
  euler.roll = std::numeric_limits<float>::quiet_NaN();
  SendMessage(euler);
  EXPECT_TRUE(poses_.empty());
  EXPECT_EQ(autopilot_->counters().not_finite, 2u);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kNotFinite), 1);
}

TEST_F(AutopilotTest, IgnoresOtherSystems) {
  Start();
  Pass(1);
  SendMessage(mavlink::Heartbeat{2, 12, 0, 0, 4, 3}, 7, 1);
  EXPECT_EQ(autopilot_->kind(), AutopilotKind::kArduPilot);
  EXPECT_THAT(TextOfEvent(AutopilotEventKind::kOtherAutopilot), HasSubstr("system 7 component 1"));
  SendPose();
  poses_.clear();
  SendMessage(AttitudeAt(BootMs() + 200), 7, 1);
  EXPECT_TRUE(poses_.empty());
  EXPECT_GT(autopilot_->counters().other_systems, 0u);
  SendMessage(mavlink::LandingTarget{}, 1, 1);
  SendMessage(mavlink::LandingTarget{}, 1, 1);
  EXPECT_EQ(autopilot_->counters().target_echoes, 2u);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kTargetEcho), 1);
}

TEST_F(AutopilotTest, ReportsIdClash) {
  Start();
  Pass(1);
  SendMessage(mavlink::Heartbeat{18, 8, 0, 0, 4, 3}, 1, 191);
  EXPECT_THAT(TextOfEvent(AutopilotEventKind::kIdClash),
              HasSubstr("somebody else sends as system 1 component 191"));
}

TEST_F(AutopilotTest, ReportsOwnIdsEqualToAutopilot) {
  ConnectionOptions options;
  options.component_id = 1;
  Start({}, options);
  SendHeartbeat();
  EXPECT_THAT(TextOfEvent(AutopilotEventKind::kOwnIdIsAutopilots),
              HasSubstr("system 1 component 1 is the autopilot itself"));
}

TEST_F(AutopilotTest, ReportsLossAndReturnOfAutopilot) {
  Start();
  Pass(1);
  Pass(4, false);
  EXPECT_FALSE(autopilot_->is_here());
  EXPECT_EQ(EventsOf(AutopilotEventKind::kAway), 1);
  SendHeartbeat();
  EXPECT_TRUE(autopilot_->is_here());
  EXPECT_EQ(EventsOf(AutopilotEventKind::kBack), 1);
}

TEST_F(AutopilotTest, ReportsVehicleState) {
  Start();
  EXPECT_FALSE(autopilot_->is_position_good(now_));
  SendMessage(
      mavlink::Heartbeat{mavlink::kTypeSurfaceBoat, mavlink::kAutopilotArduPilot, 0, 0, 4, 3});
  EXPECT_FALSE(autopilot_->is_multicopter());
  EXPECT_STREQ(VehicleName(autopilot_->vehicle_type()), "a boat");
  Pass(1);
  EXPECT_TRUE(autopilot_->is_multicopter());
  EXPECT_EQ(intervals_us_[mavlink::EkfStatusReport::kId], 500000);
  mavlink::SysStatus system;
  system.voltage_battery = 15200;
  system.current_battery = -1;
  system.battery_remaining = 41;
  SendMessage(system);
  EXPECT_NEAR(*autopilot_->battery()->voltage_v, 15.2, 1e-9);
  EXPECT_FALSE(autopilot_->battery()->current_a);
  EXPECT_NEAR(*autopilot_->battery()->remaining, 0.41, 1e-9);
  EXPECT_FALSE(autopilot_->status().gnss());
  mavlink::GpsRawInt gnss;
  gnss.fix_type = 3;
  gnss.satellites_visible = 14;
  SendMessage(gnss);
  EXPECT_EQ(autopilot_->status().gnss()->fix, 3);
  EXPECT_EQ(autopilot_->status().gnss()->satellites, 14);
  gnss.satellites_visible = 255;  // not known
  SendMessage(gnss);
  EXPECT_FALSE(autopilot_->status().gnss()->satellites);
  mavlink::HomePosition home;
  home.latitude = 5;
  home.altitude = 584000;
  SendMessage(home);
  EXPECT_EQ(autopilot_->home()->altitude_m, 584);
  SendMessage(
      mavlink::Heartbeat{mavlink::kTypeQuadrotor, kind_, 0, mode_, mavlink::kStateCritical, 3});
  EXPECT_TRUE(autopilot_->is_in_failsafe());
  EXPECT_EQ(EventsOf(AutopilotEventKind::kFailsafe), 1);
}

TEST_F(AutopilotTest, ReportsQualityOfEstimate) {
  Start();
  Pass(1);
  mavlink::EkfStatusReport report;
  report.flags = 831;  // as ArduPilot reports it in flight
  SendMessage(report);
  EXPECT_EQ(autopilot_->is_position_good(now_), true);
  report.flags = mavlink::kEkfUninitialized;
  SendMessage(report);
  EXPECT_EQ(autopilot_->is_position_good(now_), false);
  report.flags = 167;  // constant position: no GNSS
  SendMessage(report);
  EXPECT_EQ(autopilot_->is_position_good(now_), false);
  EXPECT_FALSE(autopilot_->is_position_good(now_ + std::chrono::seconds(4)));
  mavlink::EstimatorStatus status;
  status.flags = 831;
  SendMessage(status);
  EXPECT_EQ(autopilot_->is_position_good(now_), true);
}

TEST_F(AutopilotTest, ReportsVersionLandedStateRangeAndTexts) {
  Start();
  Pass(1);
  mavlink::AutopilotVersion version;
  version.flight_sw_version = 4 << 24 | 5 << 16 | 7 << 8;
  SendMessage(version);
  EXPECT_EQ(autopilot_->version()->minor, 5);
  SendMessage(mavlink::ExtendedSysState{0, mavlink::kLandedInAir});
  EXPECT_EQ(autopilot_->landed_state(), LandedState::kInAir);
  mavlink::DistanceSensor range{BootMs(), 20, 1000, 345, 0, 0, mavlink::kOrientationDown};
  SendMessage(range);
  EXPECT_NEAR(autopilot_->range()->distance_m, 3.45, 1e-9);
  mavlink::Statustext text;
  SetText("PrecLand: Target Found", text.text);
  SendMessage(text);
  EXPECT_THAT(texts_, testing::ElementsAre("PrecLand: Target Found"));
}

TEST_F(AutopilotTest, ReportsTruePoseOfSimulation) {
  AutopilotOptions options;
  options.wants_true_pose = true;
  Start(options);
  Pass(1);
  EXPECT_EQ(intervals_us_[mavlink::SimState::kId], 10000);
  const GlobalPosition origin{-353632621, 1491652374, 584};
  SendMessage(mavlink::GpsGlobalOrigin{origin.latitude_e7, origin.longitude_e7, 584000});
  const GlobalPosition place = GlobalFromLocal(AutopilotKind::kArduPilot, origin, {12.5, -7.25, 4});
  mavlink::SimState state;
  state.q1 = 1;
  state.lat_int = place.latitude_e7;
  state.lon_int = place.longitude_e7;
  state.alt = 588;
  SendMessage(state);
  ASSERT_EQ(true_poses_.size(), 1u);
  EXPECT_LT((true_poses_[0].world_from_body.translation - Eigen::Vector3d(12.5, -7.25, 4)).norm(),
            0.01);
  EXPECT_NEAR(ToSeconds(now_ - true_poses_[0].time), 0.002, 0.001);
}

// SIM_STATE has no time of its own, and on a link with varying delay its arrival time is
// inaccurate.
TEST_F(AutopilotTest, TimesTruePoseBySurroundingAttitudes) {
  AutopilotOptions options;
  options.wants_true_pose = true;
  Start(options);
  Pass(1);
  SendMessage(mavlink::GpsGlobalOrigin{-353632621, 1491652374, 584000});
  SendPose();
  ASSERT_EQ(poses_.size(), 1u);
  now_ += milliseconds(500);  // time that it is on its way
  mavlink::SimState state;
  state.q1 = 1;
  state.lat_int = -353632621;
  state.lon_int = 1491652374;
  SendMessage(state);
  ASSERT_EQ(true_poses_.size(), 1u);
  EXPECT_GE(true_poses_[0].time, poses_[0].time);
  EXPECT_LE(true_poses_[0].time, poses_[0].time + milliseconds(10));
}

// PX4's heartbeat comes once a second, whatever rate is requested.
TEST_F(AutopilotTest, KnowsModeOfPx4BeforeNextHeartbeat) {
  kind_ = mavlink::kAutopilotPx4;
  mode_ = Px4CustomMode(6, 0);
  AutopilotOptions options;
  options.mode_rate_hz = 20;
  Start(options);
  Pass(1.5);
  EXPECT_TRUE(autopilot_->is_guided_mode());
  EXPECT_EQ(intervals_us_[mavlink::CurrentMode::kId], 50000);
  mavlink::CurrentMode changed;
  changed.custom_mode = Px4CustomMode(3, 0);
  SendMessage(changed);
  EXPECT_FALSE(autopilot_->is_guided_mode());
  EXPECT_EQ(autopilot_->mode_reported(), now_);
  EXPECT_EQ(EventsOf(AutopilotEventKind::kModeChanged), 1);
}

TEST_F(AutopilotTest, SendsLongTextsInPieces) {
  Start();
  autopilot_->Announce(mavlink::kSeverityInfo, "Kestrel: target found");
  auto text = last_heard_[mavlink::Statustext::kId].As<mavlink::Statustext>();
  EXPECT_EQ(TextOf(text->text), "Kestrel: target found");
  EXPECT_EQ(text->id, 0);
  autopilot_->Announce(mavlink::kSeverityInfo, std::string(60, 'x'));
  text = last_heard_[mavlink::Statustext::kId].As<mavlink::Statustext>();
  EXPECT_EQ(TextOf(text->text), std::string(10, 'x'));
  EXPECT_EQ(text->chunk_seq, 1);
  EXPECT_NE(text->id, 0);
}

TEST_F(AutopilotTest, CountsLostPackets) {
  Start();
  Pass(1);
  mavlink::PacketWriter& writer = writers_.at({1, 1});
  writer.Write(mavlink::Heartbeat{});
  writer.Write(mavlink::Heartbeat{});
  SendHeartbeat();
  EXPECT_EQ(autopilot_->counters().lost_packets, 2u);
}

TEST_F(AutopilotTest, AccelerationIsUpwardsAtRest) {
  Start();
  Pass(3);
  mavlink::RawImu raw;
  raw.time_usec = std::uint64_t{1000} * BootMs();
  raw.zacc = -1000;  // mg
  SendMessage(raw);
  mavlink::HighresImu highres;
  highres.time_usec = raw.time_usec;
  highres.zacc = -9.81F;
  SendMessage(highres);
  highres.xacc = std::numeric_limits<float>::quiet_NaN();
  SendMessage(highres);
  ASSERT_EQ(accelerations_.size(), 2u);
  for (const Eigen::Vector3d& each : accelerations_) {
    EXPECT_NEAR((each - Eigen::Vector3d(0, 0, 9.81)).norm(), 0, 0.01);
  }
}

}  // namespace
}  // namespace kestrel
