// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/tag_messages.h"

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/io/ros_messages/frame_tree.h"

namespace kestrel {
namespace {

constexpr double kMarginOfCertainty = 100;

// Calls 'take' with each tag that was seen.
template <class Take>
void ForEachSeenTag(const TargetDetection& detection, const TargetShape& shape, const Take& take) {
  for (const SeenPart& part : detection.parts.all()) {
    if (part.tag) take(shape.tags.at(*part.tag));
  }
}

// libapriltag counts pixels from their corners, Kestrel from their centres.
ImagePointMessage ImagePointOf(const CameraModel& camera, const Eigen::Vector3d& point) {
  Eigen::Vector2d pixel;
  if (camera.Project(point, &pixel) == ProjectionStatus::kOutsideModel) return {NAN, NAN};
  return {pixel.x() + 0.5, pixel.y() + 0.5};
}

TagMessage TagOf(const TargetTag& tag, const TargetDetection& detection,
                 const CameraModel& camera) {
  const RigidTransform camera_from_tag = detection.camera_from_target * tag.pattern_from_tag;
  const double half = 0.5 * tag.size_m;
  TagMessage message;
  message.family = tag.family;
  message.id = tag.id;
  message.decision_margin = static_cast<float>(kMarginOfCertainty * detection.quality);
  message.center = ImagePointOf(camera, camera_from_tag.translation);
  constexpr std::array<std::array<double, 2>, 4> kCorners{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Eigen::Vector3d place(half * kCorners[i][0], half * kCorners[i][1], 0);
    message.corners[i] = ImagePointOf(camera, camera_from_tag * place);
  }
  const CameraIntrinsics& lens = camera.intrinsics();
  Eigen::Matrix3d pinhole;
  pinhole << lens.fx_px, 0, lens.cx_px + 0.5, 0, lens.fy_px, lens.cy_px + 0.5, 0, 0, 1;
  const Eigen::Matrix3d rotation = camera_from_tag.rotation.toRotationMatrix();
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> homography;
  homography << half * rotation.col(0), -half * rotation.col(1), camera_from_tag.translation;
  homography = pinhole * homography;
  homography /= homography(2, 2);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.homography.data()) = homography;
  return message;
}

}  // namespace

TagArrayMessage TagsOf(const LandingObservation& observation, const CameraModel& camera,
                       const TargetShape& shape, const std::string& camera_frame) {
  TagArrayMessage message;
  message.header = {0, observation.time, camera_frame};
  const auto& detection = observation.report.detection;
  if (!detection) return message;
  ForEachSeenTag(*detection, shape, [&](const TargetTag& tag) {
    message.detections.push_back(TagOf(tag, *detection, camera));
  });
  return message;
}

TfMessage TagTransformsOf(const LandingObservation& observation, const TargetShape& shape,
                          const std::string& camera_frame) {
  TfMessage message;
  const auto& detection = observation.report.detection;
  if (!detection) return message;
  ForEachSeenTag(*detection, shape, [&](const TargetTag& tag) {
    TransformStampedMessage& transform = message.transforms.emplace_back();
    transform.header = {0, observation.time, camera_frame};
    transform.child_frame_id = fmt::format("{}:{}", tag.family, tag.id);
    transform.transform = TransformMessageOf(detection->camera_from_target * tag.pattern_from_tag);
  });
  return message;
}

}  // namespace kestrel
