// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/gimbal_reports.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/test_autopilot.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kHeading_deg = 50;    // heading of the vehicle, from north to east
constexpr double kPan_deg = 20;        // yaw of the platform, to the right of the vehicle
constexpr double kPitch_deg = -35;     // below the horizon
constexpr std::uint8_t kGimbal = 154;  // component

// The direction of the optical axis on the earth: 70 degrees from north to east, 35 below it.
Vector3d EarthRay() {
  const double azimuth = Radians(kHeading_deg + kPan_deg), depression = Radians(-kPitch_deg);
  return {std::sin(azimuth) * std::cos(depression), std::cos(azimuth) * std::cos(depression),
          -std::sin(depression)};
}

Vector3d EarthRayOf(const GimbalSample& sample) {
  const Vector3d ray = sample.level_from_platform * Vector3d::UnitX();
  if (sample.yaw_frame == YawFrame::kEarth) return ray;
  // The heading of the body in the world (ENU), from x (east) to y (north).
  return AngleAxisd(Radians(90 - kHeading_deg), Vector3d::UnitZ()) * ray;
}

mavlink::GimbalDeviceAttitudeStatus Report(std::uint16_t flags, double yaw_deg, double delta_yaw) {
  const Quaterniond q = AngleAxisd(Radians(yaw_deg), Vector3d::UnitZ()) *
                        AngleAxisd(Radians(kPitch_deg), Vector3d::UnitY());
  mavlink::GimbalDeviceAttitudeStatus report;
  report.flags = flags;
  report.q = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
              static_cast<float>(q.z())};
  report.delta_yaw = static_cast<float>(delta_yaw);
  return report;
}

TEST(GimbalReportsTest, EveryEncodingGivesTheSameEarthRay) {
  constexpr std::uint16_t kVehicle = mavlink::kGimbalYawInVehicleFrame;
  constexpr std::uint16_t kEarth = mavlink::kGimbalYawInEarthFrame;
  constexpr std::uint16_t kLock = mavlink::kGimbalYawLock;
  constexpr std::uint16_t kOthers = 4 + 8;  // roll and pitch lock, which ArduPilot always sets
  struct Case {
    std::uint16_t flags;
    bool is_earth;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Case& one :
       {Case{kVehicle, false}, Case{kVehicle | kLock, false}, Case{kVehicle | kOthers, false},
        Case{kEarth, true}, Case{kEarth | kLock, true}, Case{kLock, true},
        Case{kLock | kOthers, true}, Case{kOthers, false}, Case{0, false}}) {
    const double yaw_deg = one.is_earth ? kHeading_deg + kPan_deg : kPan_deg;
    for (const double delta_yaw : {0.0, Radians(kHeading_deg), nan}) {
      const auto sample = GimbalSampleOf(Report(one.flags, yaw_deg, delta_yaw));
      ASSERT_TRUE(sample);
      EXPECT_LT((EarthRayOf(*sample) - EarthRay()).norm(), 1e-6)
          << "flags " << one.flags << ", delta_yaw " << delta_yaw;
    }
  }
  mavlink::MountOrientation old;
  old.pitch = kPitch_deg;
  old.yaw = kPan_deg;
  EXPECT_LT((EarthRayOf(*GimbalSampleOf(old)) - EarthRay()).norm(), 1e-6);
}

TEST(GimbalReportsTest, RejectsWhatIsNoRotation) {
  mavlink::GimbalDeviceAttitudeStatus report;
  EXPECT_FALSE(GimbalSampleOf(report));
  report.q = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  EXPECT_FALSE(GimbalSampleOf(report));
  mavlink::MountOrientation old;
  old.pitch = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(GimbalSampleOf(old));
}

class GimbalOnLinkTest : public AutopilotTest {
 protected:
  void StartWithGimbal(int device_id) {
    AutopilotOptions options;
    options.gimbal_device_id = device_id;
    Start(options);
    Pass(5);
  }
  // 'turned_deg': from where it looks at first.
  void SendGimbal(int device_id, int component, std::uint32_t boot_ms, double turned_deg = 0) {
    auto report = Report(mavlink::kGimbalYawInVehicleFrame, kPan_deg + turned_deg, 0);
    report.time_boot_ms = boot_ms;
    report.gimbal_device_id = static_cast<std::uint8_t>(device_id);
    SendMessage(report, 1, component);
  }
};

TEST_F(GimbalOnLinkTest, RequestsAndConvertsReportsOfAutopilot) {
  StartWithGimbal(0);
  EXPECT_EQ(intervals_us_[mavlink::GimbalDeviceAttitudeStatus::kId], 20000);
  SendGimbal(1, 1, BootMs());
  ASSERT_EQ(gimbal_.size(), 1u);
  EXPECT_NEAR(ToSeconds(gimbal_[0].time - now_), 0, 0.003);
  EXPECT_LT((EarthRayOf(gimbal_[0]) - EarthRay()).norm(), 1e-6);
}

TEST_F(GimbalOnLinkTest, RequestsNothingWithoutGimbal) {
  Start();
  Pass(5);
  EXPECT_EQ(intervals_us_.count(mavlink::GimbalDeviceAttitudeStatus::kId), 0u);
  SendGimbal(1, 1, BootMs());
  EXPECT_TRUE(gimbal_.empty());
}

TEST_F(GimbalOnLinkTest, UsesOneOfSeveralGimbals) {
  StartWithGimbal(2);
  SendGimbal(1, 1, BootMs());
  SendGimbal(2, 1, BootMs());
  EXPECT_EQ(gimbal_.size(), 1u);
  StartWithGimbal(0);
  gimbal_.clear();
  SendGimbal(1, 1, BootMs());
  SendGimbal(2, 1, BootMs());
  EXPECT_EQ(gimbal_.size(), 1u);
}

TEST_F(GimbalOnLinkTest, LearnsClockOfGimbalThatIsComponent) {
  StartWithGimbal(0);
  constexpr std::uint32_t kOtherBoot_ms = 7'000'000;
  for (int i = 0; i < 100; ++i) {
    Pass(0.05);
    SendGimbal(0, kGimbal, BootMs() - kOtherBoot_ms, i);
  }
  ASSERT_GT(gimbal_.size(), 20u);
  EXPECT_NEAR(ToSeconds(gimbal_.back().time - now_), 0, 0.005);
}

// An autopilot repeats the newest report of a slow gimbal, with later times.
TEST_F(GimbalOnLinkTest, LeavesOutRepeatedReports) {
  StartWithGimbal(0);
  for (int i = 0; i < 40; ++i) {
    Pass(0.02);
    SendGimbal(1, 1, BootMs(), i / 10);
  }
  EXPECT_EQ(gimbal_.size(), 4u);
  gimbal_.clear();
  for (int i = 0; i < 100; ++i) {
    Pass(0.02);
    SendGimbal(1, 1, BootMs(), 3);
  }
  EXPECT_NEAR(gimbal_.size(), 8, 1) << "a gimbal that stands";
}

TEST_F(GimbalOnLinkTest, OldReportsYieldToNewOnes) {
  StartWithGimbal(0);
  mavlink::MountOrientation old;
  old.time_boot_ms = BootMs();
  SendMessage(old);
  EXPECT_EQ(gimbal_.size(), 1u);
  SendGimbal(1, 1, BootMs() + 10);
  SendMessage(old);
  EXPECT_EQ(gimbal_.size(), 2u);
}

}  // namespace
}  // namespace kestrel
