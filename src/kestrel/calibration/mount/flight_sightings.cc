// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/flight_sightings.h"

#include <cmath>
#include <utility>

#include "kestrel/core/base/error.h"

namespace kestrel {

MountAndClock GivenMountAndClock(const CameraCalibration& calibration, const std::string& file) {
  if (!calibration.body_from_camera) {
    throw InputError(file +
                     ": the calibration has no mount, expected T_BS, T_cam_imu or, in a bag, tf to "
                     "start from");
  }
  const Duration image_offset = calibration.clock_offset.value_or(Duration::zero());
  if (const auto& gimbal = calibration.gimbal) {
    return {gimbal->platform_from_camera, ToSeconds(image_offset - gimbal->clock_offset)};
  }
  return {*calibration.body_from_camera, ToSeconds(image_offset)};
}

std::optional<FlownGimbal> FlownGimbalOf(const CameraCalibration& calibration,
                                         std::vector<GimbalSample> reports,
                                         const std::string& file) {
  if (!calibration.gimbal) return std::nullopt;
  if (reports.empty()) {
    throw InputError(file + ": has no reports of the gimbal, expected gimbal0/data.csv");
  }
  const Duration image_offset = calibration.clock_offset.value_or(Duration::zero());
  return FlownGimbal{calibration.gimbal->body_from_pivot, std::move(reports),
                     ToSeconds(image_offset)};
}

void RequireOwnLens(const CameraCalibration& calibration, const std::vector<ZoomSample>& reports,
                    const std::string& file) {
  constexpr double kTolerance = 0.02;
  if (!calibration.zoom) return;
  const double own = calibration.intrinsics.fx_px;
  for (const ZoomSample& report : reports) {
    const auto lens = LensAt(*calibration.zoom, report.view_rad);
    if (lens && std::abs(lens->fx_px - own) <= kTolerance * own) continue;
    throw InputError(file +
                     ": the lens zooms in it, expected a flight at the setting of the "
                     "camera file's own lens");
  }
}

void SetMountAndClock(const MountAndClock& estimate, CameraCalibration* calibration) {
  const Duration offset = DurationFromSeconds(estimate.clock_offset_s);
  if (auto& gimbal = calibration->gimbal) {
    gimbal->platform_from_camera = estimate.body_from_camera;
    gimbal->clock_offset = calibration->clock_offset.value_or(Duration::zero()) - offset;
    calibration->body_from_camera = gimbal->body_from_pivot * gimbal->platform_from_camera;
    return;
  }
  calibration->body_from_camera = estimate.body_from_camera;
  calibration->clock_offset = offset;
}

FlightSightings::FlightSightings(const CameraIntrinsics& camera,
                                 const LandingPipelineOptions& options)
    : detector_(MakeTargetDetector(CameraModel(camera), options.target, options.detector)),
      workspace_(detector_->MakeWorkspace()),
      noise_(options.noise) {}

void FlightSightings::Add(const cv::Mat& image, Time time) {
  const TargetReport report = detector_->Detect(image, {}, *workspace_);
  if (!report.detection) return;
  const RigidTransform& pose = report.detection->camera_from_target;
  const Eigen::Matrix3d covariance =
      CovarianceInWorld(report.detection->covariance.topLeftCorner<3, 3>(), pose.translation,
                        Eigen::Quaterniond::Identity(), noise_);
  sightings_.push_back({time, pose.translation, std::sqrt(covariance.trace() / 3)});
  places_.push_back({{static_cast<float>(report.detection->center_px.x()),
                      static_cast<float>(report.detection->center_px.y())},
                     pose.Inverse().translation.z()});
}

}  // namespace kestrel
