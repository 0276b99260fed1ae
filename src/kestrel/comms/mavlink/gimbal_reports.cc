// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/gimbal_reports.h"

#include <chrono>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/autopilot_status.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

YawFrame YawFrameOf(std::uint16_t flags) {
  if ((flags & mavlink::kGimbalYawInVehicleFrame) != 0) return YawFrame::kVehicle;
  const std::uint16_t earth = mavlink::kGimbalYawInEarthFrame | mavlink::kGimbalYawLock;
  return (flags & earth) != 0 ? YawFrame::kEarth : YawFrame::kVehicle;
}

// 'level_from_frd': the platform (forward, right, down) in a level frame with z down, and x to the
// north or along the vehicle's heading.
std::optional<GimbalSample> SampleOf(const Quaterniond& level_from_frd, YawFrame frame) {
  constexpr double kTolerance = 0.01;
  if (!(std::abs(level_from_frd.norm() - 1) < kTolerance)) return std::nullopt;
  const Quaterniond frd_from_flu(0, 1, 0, 0);
  const Quaterniond rotation = frame == YawFrame::kEarth
                                   ? EnuFluFromNedFrd(level_from_frd)
                                   : frd_from_flu * level_from_frd * frd_from_flu;
  return GimbalSample{{}, rotation.normalized(), frame};
}

}  // namespace

std::optional<GimbalSample> GimbalSampleOf(const mavlink::GimbalDeviceAttitudeStatus& report) {
  const auto& q = report.q;
  return SampleOf(Quaterniond(q[0], q[1], q[2], q[3]), YawFrameOf(report.flags));
}

std::optional<GimbalSample> GimbalSampleOf(const mavlink::MountOrientation& report) {
  return SampleOf(Quaterniond(AngleAxisd(Radians(report.yaw), Vector3d::UnitZ()) *
                              AngleAxisd(Radians(report.pitch), Vector3d::UnitY()) *
                              AngleAxisd(Radians(report.roll), Vector3d::UnitX())),
                  YawFrame::kVehicle);
}

bool GimbalReports::IsWanted(int device_id) {
  if (wanted_ != 0 && device_id != wanted_) return false;
  if (device_id_ == 0) device_id_ = device_id;
  return device_id == device_id_;
}

// An autopilot that is asked for more reports than its gimbal makes repeats the newest one with a
// later time: a gimbal that turns would seem to turn in steps. One that stands is the same for
// long.
bool GimbalReports::IsRepeated(const GimbalSample& sample) {
  constexpr Duration kSlowest = std::chrono::milliseconds(250);
  const bool is_repeated =
      newest_ && newest_->level_from_platform.coeffs() == sample.level_from_platform.coeffs() &&
      newest_->yaw_frame == sample.yaw_frame && sample.time > newest_->time &&
      sample.time - newest_->time < kSlowest;
  if (!is_repeated) newest_ = sample;
  return is_repeated;
}

std::optional<GimbalSample> GimbalReports::Handle(const mavlink::Packet& packet, Time received,
                                                  std::uint8_t autopilot, const TimeSync& clock) {
  std::optional<GimbalSample> sample;
  std::uint32_t boot_ms = 0;
  int device_id = packet.component;
  if (const auto report = packet.As<mavlink::GimbalDeviceAttitudeStatus>()) {
    const int reported = report->gimbal_device_id;
    if (reported > 0 && reported <= mavlink::kLastDeviceBehindAutopilot) device_id = reported;
    has_new_reports_ = true;
    sample = GimbalSampleOf(*report);
    boot_ms = report->time_boot_ms;
  } else if (const auto old = packet.As<mavlink::MountOrientation>(); old && !has_new_reports_) {
    device_id = 1;
    sample = GimbalSampleOf(*old);
    boot_ms = old->time_boot_ms;
  }
  if (!sample || !IsWanted(device_id)) return std::nullopt;
  const std::int64_t remote_ns = NanosecondsOfBoot(boot_ms);
  if (packet.component != autopilot) own_clock_.AddOneWay(remote_ns, received);
  const TimeSync& its_clock = packet.component == autopilot ? clock : own_clock_;
  if (!its_clock.is_known()) return std::nullopt;
  sample->time = its_clock.ToLocal(remote_ns);
  if (IsRepeated(*sample)) return std::nullopt;
  return sample;
}

}  // namespace kestrel
