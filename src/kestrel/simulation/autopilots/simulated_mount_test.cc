// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_mount.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/gimbal_reports.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/poses/gimbal_history.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr LinkId kCompanion{1, 191};
constexpr LinkId kOther{255, 190};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

mavlink::CommandLong Configure(const LinkId& id) {
  mavlink::CommandLong command;
  command.command = mavlink::kCommandGimbalConfigure;
  command.param1 = id.system;
  command.param2 = id.component;
  return command;
}

// Looks down by 40 degrees and to the east.
mavlink::GimbalManagerSetPitchyaw DownToEast() {
  mavlink::GimbalManagerSetPitchyaw message;
  message.flags = mavlink::kGimbalYawLock;
  message.pitch = static_cast<float>(Radians(-40.0));
  message.yaw = static_cast<float>(kPi / 2);
  message.pitch_rate = message.yaw_rate = kNan;
  return message;
}

class SimulatedMountTest : public testing::TestWithParam<AutopilotFirmware> {
 protected:
  void Start(SimulatedMountOptions options = {}) {
    options.noise_deg = 0;
    mount_.emplace(GetParam(), options, /*system=*/1, now_, Random(1));
  }
  void Pass(double seconds) {
    for (const Time end = now_ + DurationFromSeconds(seconds); now_ < end;) {
      now_ += std::chrono::milliseconds(4);
      mount_->Step(now_, body_);
    }
  }
  // The direction in the world in which the gimbal looks, and what it reports of that.
  Vector3d TrueRay() const { return mount_->world_from_platform() * Vector3d::UnitX(); }
  Vector3d ReportedRay() const {
    const auto sample = GimbalSampleOf(mount_->AttitudeMessage(0));
    const GimbalAttitude attitude{sample->level_from_platform, sample->yaw_frame};
    return WorldFromPlatform(body_, {}, attitude).rotation * Vector3d::UnitX();
  }
  double PitchDown() const { return Degrees(std::asin(-TrueRay().z())); }

  Time now_ = TimeFromNanoseconds(5'000'000'000);
  RigidTransform body_{Eigen::Quaterniond(Eigen::AngleAxisd(Radians(130.0), Vector3d::UnitZ())),
                       {0, 0, 10}};
  std::optional<SimulatedMount> mount_;
};
INSTANTIATE_TEST_SUITE_P(Both, SimulatedMountTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(SimulatedMountTest, ReportsItsAttitudeInItsOwnFrame) {
  Start();
  Pass(1);
  EXPECT_LT((ReportedRay() - body_.rotation * Vector3d::UnitX()).norm(), 1e-5) << "level, ahead";
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(5);
  const double depression = Radians(40.0);
  const Vector3d expected(std::cos(depression), 0, -std::sin(depression));
  EXPECT_LT((TrueRay() - expected).norm(), 1e-3);
  EXPECT_LT((ReportedRay() - TrueRay()).norm(), 1e-5);
}

TEST_P(SimulatedMountTest, TurnsNoFasterThanItsMotors) {
  SimulatedMountOptions options;
  options.max_turn_dps = 20;
  Start(options);
  Pass(0.1);
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(1);
  EXPECT_NEAR(PitchDown(), 20, 0.2);
}

TEST_P(SimulatedMountTest, StaysWithinItsRange) {
  SimulatedMountOptions options;
  options.pitch_min_deg = -30;
  options.yaw_max_deg = 60;
  Start(options);
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(5);
  EXPECT_NEAR(PitchDown(), 30, 0.1);
  EXPECT_NEAR(Degrees(std::atan2(TrueRay().y(), TrueRay().x())), 130 - 60, 0.1);
}

TEST_P(SimulatedMountTest, OnlyPx4AsksWhoIsInControl) {
  Start();
  mount_->Execute(Configure(kOther), kOther, now_);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(5);
  const bool is_px4 = GetParam() == AutopilotFirmware::kPx4;
  EXPECT_NEAR(PitchDown(), is_px4 ? 0 : 40, 0.1);
  EXPECT_EQ(mount_->StatusMessage(0).primary_control_sysid, kOther.system);
}

TEST_P(SimulatedMountTest, OnlyPx4TakesAnglesWithRates) {
  Start();
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mavlink::GimbalManagerSetPitchyaw both = DownToEast();
  both.pitch_rate = both.yaw_rate = 0;
  mount_->Handle(both, kCompanion, now_);
  Pass(5);
  EXPECT_NEAR(PitchDown(), GetParam() == AutopilotFirmware::kPx4 ? 40 : 0, 0.1);
}

TEST_P(SimulatedMountTest, RatesEndAfterThreeSeconds) {
  Start();
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mavlink::GimbalManagerSetPitchyaw rates;
  rates.pitch = rates.yaw = kNan;
  rates.pitch_rate = static_cast<float>(Radians(-10.0));
  mount_->Handle(rates, kCompanion, now_);
  Pass(6);
  EXPECT_NEAR(PitchDown(), 30, 0.5);
}

TEST_P(SimulatedMountTest, StickTakesGimbal) {
  SimulatedMountOptions options;
  options.stick_after_s = 5;
  Start(options);
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(4.9);
  EXPECT_EQ(mount_->ChannelsMessage(0).chan7_raw, 1500);
  Pass(1);
  EXPECT_EQ(mount_->ChannelsMessage(0).chan7_raw, 1800);
  EXPECT_LT(PitchDown(), 25);
  const LinkId expected = GetParam() == AutopilotFirmware::kPx4 ? LinkId{1, 1} : kCompanion;
  const mavlink::GimbalManagerStatus status = mount_->StatusMessage(0);
  EXPECT_EQ((LinkId{status.primary_control_sysid, status.primary_control_compid}), expected);
}

TEST_P(SimulatedMountTest, EchoedSetPointHasNoLag) {
  SimulatedMountOptions options;
  options.echoes = true;
  Start(options);
  mount_->Execute(Configure(kCompanion), kCompanion, now_);
  Pass(1);
  mount_->Handle(DownToEast(), kCompanion, now_);
  Pass(0.06);
  EXPECT_NEAR(Degrees(std::asin(-ReportedRay().z())), 40, 0.1);
  EXPECT_LT(PitchDown(), 10);
}

}  // namespace
}  // namespace kestrel
