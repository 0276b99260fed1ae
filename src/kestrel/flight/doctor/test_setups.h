// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cmath>
#include <string>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/doctor/observations.h"
#include "kestrel/flight/doctor/parameter_checks.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"

namespace kestrel {

constexpr double kPeriod_s = 0.05;
constexpr int kFrames = 160;

inline Time FrameTime(int i) {
  return Time(std::chrono::seconds(100)) + DurationFromSeconds(kPeriod_s * i);
}

// A camera under the body that looks down; the top of its image is ahead.
inline RigidTransform DownwardMount() {
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  return {Eigen::Quaterniond(body_from_camera), {0.1, 0, -0.05}};
}

// Pose of a UAV that somebody holds above the origin and tilts about.
inline RigidTransform HeldPose(double time_s, double tilt_deg) {
  const Eigen::Quaterniond level(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d tilt =
      Radians(tilt_deg) * Eigen::Vector3d(std::sin(2 * time_s), std::cos(1.3 * time_s), 0);
  return {level * RotationBy(tilt), {0.3, -0.2, 2.5}};
}

// Returns what a camera with 'true_mount' sees of a pattern at the origin.
inline std::vector<PatternSample> PatternsSeen(const RigidTransform& true_mount, double tilt_deg) {
  std::vector<PatternSample> patterns;
  for (int i = 0; i < kFrames; i += 2) {
    PatternSample sample;
    sample.time = FrameTime(i);
    sample.world_from_body = HeldPose(kPeriod_s * i, tilt_deg);
    sample.camera_from_target = (*sample.world_from_body * true_mount).Inverse();
    sample.ring_px = 100;
    sample.misfit_px = 0.2;
    patterns.push_back(sample);
  }
  return patterns;
}

inline ImageQuality GoodQuality(int i) {
  ImageQuality quality;
  quality.mean_gray = 110;
  quality.bright_gray = 220;
  quality.dark_gray = 20;
  quality.saturated_share = 0.001;
  quality.edge_px = 2;
  quality.hash = static_cast<std::uint64_t>(i);
  return quality;
}

inline CameraObservations GoodCamera() {
  CameraObservations camera;
  camera.duration_s = kPeriod_s * kFrames;
  camera.width_px = 752;
  camera.height_px = 480;
  for (int i = 0; i < kFrames; ++i) {
    camera.frames.push_back({FrameTime(i), FrameTime(i) + std::chrono::milliseconds(30)});
    camera.qualities.push_back(GoodQuality(i));
  }
  camera.counters.captured = kFrames;
  return camera;
}

inline LinkObservations GoodLink(AutopilotKind kind) {
  LinkObservations link;
  link.isrequested = true;
  link.scheme = LinkScheme::kSerial;
  link.baud = 921600;
  link.counters.received = 1500;
  link.counters.sent = 200;
  link.is_heard = true;
  link.kind = kind;
  link.version =
      kind == AutopilotKind::kPx4 ? AutopilotVersion{1, 18, 0} : AutopilotVersion{4, 7, 0};
  link.vehicle_type = mavlink::kTypeQuadrotor;
  link.mode = "LOITER";
  link.heartbeats = 8;
  link.listened_s = 5;
  link.attitudes = 490;
  link.positions = 245;
  link.attitude_age_s = 0.01;
  link.position_age_s = 0.02;
  link.has_good_position = true;
  link.knows_clock = true;
  link.round_trip_s = 0.004;
  link.drift = 1e-5;
  link.clock_sigma_s = 0.001;
  link.own_system = 1;
  link.autopilot_system = 1;
  return link;
}

// Parameters of the simulated autopilot.
inline ParameterValues DefaultParameters(AutopilotKind kind) {
  const AutopilotParameters defaults(kind == AutopilotKind::kPx4 ? AutopilotFirmware::kPx4
                                                                 : AutopilotFirmware::kArduPilot);
  ParameterValues values;
  for (const auto& [name, wants] : CheckedParameters(kind)) {
    if (!defaults.Find(name)) continue;
    values[std::string(name)] = {defaults[name], std::string(name), 1};
  }
  return values;
}

// A set-up that is right for landing on a standing pattern.
inline DoctorObservations GoodSetup(AutopilotKind kind) {
  DoctorObservations all;
  all.calibration.intrinsics = {752, 480, 420, 420, 375.5, 239.5, DistortionModel::kNone, {}};
  all.calibration.body_from_camera = DownwardMount();
  all.camera = GoodCamera();
  all.vision.frames = kFrames;
  all.vision.patterns = PatternsSeen(DownwardMount(), 15);
  all.vision.detect_s = 0.004;
  all.vision.detect_p90_s = 0.008;
  all.vision.latency_s = 0.04;
  all.link = GoodLink(kind);
  all.parameters = DefaultParameters(kind);
  all.computer = {4, 1.5, 55, 0, 20'000, 200, 0.36};
  all.computer.is_time_synchronized = true;
  all.use.record = "flight";
  return all;
}

// A UAV that flies and turns beside the origin, and the attitude of a gimbal that looks about
// there.
inline RigidTransform TurningPose(double time_s) {
  RigidTransform pose = HeldPose(time_s, 10);
  pose.rotation =
      RotationBy(0.8 * std::sin(0.9 * time_s) * Eigen::Vector3d::UnitZ()) * pose.rotation;
  pose.translation += Eigen::Vector3d(1.5 + 0.5 * std::sin(time_s), std::cos(time_s), 0);
  return pose;
}
inline Eigen::Quaterniond MovingGaze(double time_s) {
  const Eigen::Vector3d ray = -TurningPose(time_s).translation;
  return GimbalAngles{std::atan2(ray.y(), ray.x()) + 0.3 * std::sin(1.9 * time_s),
                      std::atan2(-ray.z(), ray.head<2>().norm()) + 0.15 * std::sin(2.3 * time_s)}
      .rotation();
}

// The same set-up with the camera on a gimbal, over which the UAV turns. 'echo_s': so much later
// than its reports the gimbal is where they say.
inline DoctorObservations OnGimbal(DoctorObservations all, double echo_s = 0) {
  GimbalMount& mount = all.calibration.gimbal.emplace();
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mount.platform_from_camera.rotation = Eigen::Quaterniond(axes);
  all.vision.patterns.clear();
  for (int i = 0; i < kFrames; ++i) {
    const double time_s = kPeriod_s * i;
    const RigidTransform body = TurningPose(time_s);
    all.gimbal.reports.push_back(
        {{FrameTime(i), MovingGaze(time_s), YawFrame::kEarth}, body.rotation});
    PatternSample sample;
    sample.time = FrameTime(i);
    sample.world_from_body = body;
    const RigidTransform platform{MovingGaze(time_s - echo_s), body.translation};
    sample.camera_from_target = (platform * mount.platform_from_camera).Inverse();
    sample.ring_px = 100;
    sample.misfit_px = 0.2;
    all.vision.patterns.push_back(sample);
  }
  all.link.gimbal_reports = 100;
  all.gimbal.range = GimbalRange{};
  all.gimbal.controller = {0, 0};
  all.use.points = true;
  const auto set = [&](const std::string& name, double value) {
    if (all.parameters.contains(name)) all.parameters[name].value = value;
  };
  set("MNT1_TYPE", 6);
  set("MNT_MODE_IN", 4);
  set("MNT_MODE_OUT", 2);
  return all;
}

// A set-up that is also right for guidance onto a car.
inline DoctorObservations GoodGuidedSetup(AutopilotKind kind) {
  DoctorObservations all = GoodSetup(kind);
  all.use.guides = true;
  all.use.target_mps = 4.2;
  const auto set = [&](const std::string& name, double value) {
    all.parameters[name] = {value, name, 1};
  };
  if (kind == AutopilotKind::kPx4) {
    set("COM_RC_OVERRIDE", 3);
    set("LNDMC_XY_VEL_MAX", 6);
    set("MAN_OVERRIDE_SPD", 1);
    set("COM_OF_LOSS_T", 0.3);
    set("COM_OBL_RC_ACT", 5);
  } else {
    set("WP_ACC", 6);
    set("PSC_JERK_NE", 20);
    set("PLND_OPTIONS", 1);
    set("PLND_STRICT", 0);
    set("PLND_RET_MAX", 0);
    set("PLND_XY_DIST_MAX", 0);
    set("GUID_TIMEOUT", 0.3);
  }
  return all;
}

// A set-up without GNSS that is right for guidance by a pad that stands, which is its position.
inline DoctorObservations GoodPadSetup(AutopilotKind kind) {
  DoctorObservations all = GoodGuidedSetup(kind);
  all.use.target_mps.reset();
  all.use.pad_position = all.use.has_pad_origin = true;
  all.link.positions = 0;
  all.link.has_good_position = false;
  const auto set = [&](const std::string& name, double value) {
    all.parameters[name] = {value, name, 1};
  };
  if (kind == AutopilotKind::kPx4) {
    set("EKF2_EV_CTRL", 11);
    set("EKF2_NOAID_TOUT", 1e6);
    set("EKF2_GPS_CTRL", 0);
    set("SYS_HAS_GPS", 0);
    set("COM_OBL_RC_ACT", 4);
    set("NAV_RCL_ACT", 3);
  } else {
    set("VISO_TYPE", 1);
    set("VISO_DELAY_MS", 40);
    set("EK3_SRC1_POSXY", 6);
    set("EK3_SRC1_VELXY", 0);
    set("EK3_SRC1_VELZ", 0);
    set("GPS1_TYPE", 0);
    set("FS_THR_ENABLE", 3);
  }
  return all;
}

// The same for a flight without any position.
inline DoctorObservations GoodNoPositionSetup(AutopilotKind kind) {
  DoctorObservations all = GoodGuidedSetup(kind);
  all.use.target_mps.reset();
  all.use.no_position = true;
  all.link.positions = 0;
  all.link.has_good_position = false;
  const auto set = [&](const std::string& name, double value) {
    all.parameters[name] = {value, name, 1};
  };
  if (kind == AutopilotKind::kPx4) {
    set("COM_OBL_RC_ACT", 4);
    set("COM_ARM_WO_GPS", 1);
    set("SYS_HAS_GPS", 0);
    set("MPC_USE_HTE", 1);
  } else {
    set("GUID_OPTIONS", 0);
    set("FENCE_ENABLE", 0);
    set("FS_EKF_ACTION", 1);
    set("MOT_THST_HOVER", 0.28);
  }
  return all;
}

}  // namespace kestrel
