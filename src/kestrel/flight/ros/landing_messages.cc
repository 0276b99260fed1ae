// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/landing_messages.h"

#include <algorithm>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "kestrel/flight/ros/message_covariance.h"
#include "kestrel/io/ros_messages/frame_tree.h"

namespace kestrel {
namespace {

constexpr double kBoardThickness_m = 0.01;
constexpr double kShaft_m = 0.1;
constexpr double kHead_m = 0.2;
constexpr double kShownSigmas = 3;

Vector3Message MessageOf(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

PointMessage PointOf(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

HeaderMessage HeaderOf(Time stamp, const std::string& frame) { return {0, stamp, frame}; }

RigidTransform PoseOf(const TargetEstimate& target) {
  return {RotationBy({0, 0, target.heading()}), target.motion.position()};
}

// Variance of the velocity's direction (rad^2); unknown for a target that stands.
double HeadingVariance(const TurnState& motion) {
  const Eigen::Vector2d velocity = motion.velocity().head<2>();
  const double squared_speed = velocity.squaredNorm();
  if (!(squared_speed > 0)) return kUnknownAngleVariance;
  const Eigen::Vector2d across(-velocity.y(), velocity.x());
  const double variance = across.dot(motion.covariance.block<2, 2>(3, 3) * across);
  return std::min(variance / (squared_speed * squared_speed), kUnknownAngleVariance);
}

MarkerMessage Marker(const std::string& name, Time stamp, const std::string& frame,
                     MarkerMessage::Shape shape) {
  MarkerMessage marker;
  marker.header = HeaderOf(stamp, frame);
  marker.name_space = name;
  marker.type = shape;
  marker.lifetime = {1, 0};  // RViz forgets the marker soon after the node ends
  return marker;
}

MarkerMessage PatternMarker(const LandingObservation& observation, const TargetShape& shape,
                            const std::string& camera_frame) {
  MarkerMessage marker =
      Marker("pattern", observation.time, camera_frame, MarkerMessage::kCylinder);
  if (!observation.report.detection) {
    marker.action = MarkerMessage::kDelete;
    return marker;
  }
  marker.pose = PoseMessageOf(observation.report.detection->camera_from_target);
  marker.scale = {shape.diameter_m, shape.diameter_m, kBoardThickness_m};
  marker.color = {0, 1, 0, 0.6F};
  return marker;
}

MarkerMessage VelocityMarker(const LandingObservation& observation, const std::string& world) {
  MarkerMessage marker = Marker("velocity", observation.time, world, MarkerMessage::kArrow);
  if (!observation.target) {
    marker.action = MarkerMessage::kDelete;
    return marker;
  }
  const TurnState& motion = observation.target->motion;
  marker.points = {PointOf(motion.position()), PointOf(motion.position() + motion.velocity())};
  marker.scale = {kShaft_m, kHead_m, 0};
  marker.color = {1, 0.6F, 0, 0.9F};
  return marker;
}

MarkerMessage UncertaintyMarker(const LandingObservation& observation, const std::string& world) {
  MarkerMessage marker = Marker("uncertainty", observation.time, world, MarkerMessage::kSphere);
  if (!observation.target) {
    marker.action = MarkerMessage::kDelete;
    return marker;
  }
  const TurnState& motion = observation.target->motion;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      motion.covariance.topLeftCorner<3, 3>());
  Eigen::Matrix3d rotation = axes.eigenvectors();
  if (rotation.determinant() < 0) rotation.col(0) *= -1;
  marker.pose = PoseMessageOf({Eigen::Quaterniond(rotation), motion.position()});
  marker.scale = MessageOf(2 * kShownSigmas * axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt());
  marker.color = {1, 0.6F, 0, 0.3F};
  return marker;
}

}  // namespace

Detection3DArrayMessage DetectionsOf(const LandingObservation& observation,
                                     const std::string& camera_frame, const TargetShape& shape) {
  Detection3DArrayMessage message;
  message.header = HeaderOf(observation.time, camera_frame);
  const auto& detection = observation.report.detection;
  if (!detection) return message;
  Detection3DMessage& found = message.detections.emplace_back();
  found.header = message.header;
  if (detection->id) found.id = std::to_string(*detection->id);
  found.box = {PoseMessageOf(detection->camera_from_target),
               {shape.board_size_m, shape.board_size_m, kBoardThickness_m}};
  found.results.push_back({{"landing_pattern", detection->quality},
                           {found.box.center, NumbersOf(detection->covariance)}});
  return message;
}

PoseWithCovarianceStampedMessage TargetPoseOf(const TargetDetection& detection, Time stamp,
                                              const std::string& camera_frame) {
  return {HeaderOf(stamp, camera_frame),
          {PoseMessageOf(detection.camera_from_target), NumbersOf(detection.covariance)}};
}

TfMessage PatternTransformOf(const TargetDetection& detection, Time stamp,
                             const std::string& camera_frame, const std::string& pattern_frame) {
  TfMessage message;
  message.transforms.push_back({HeaderOf(stamp, camera_frame), pattern_frame,
                                TransformMessageOf(detection.camera_from_target)});
  return message;
}

OdometryMessage TrackOf(const TargetEstimate& target, const std::string& world_frame,
                        const std::string& target_frame) {
  const TurnState& motion = target.motion;
  const RigidTransform world_from_target = PoseOf(target);
  const Eigen::Matrix3d target_from_world = world_from_target.rotation.conjugate().matrix();

  MessageCovariance pose = MessageCovariance::Zero();
  pose.topLeftCorner<3, 3>() = motion.covariance.topLeftCorner<3, 3>();
  pose.diagonal().tail<3>() << kUnknownAngleVariance, kUnknownAngleVariance,
      HeadingVariance(motion);

  const Eigen::Vector3d with_turn = target_from_world * motion.covariance.block<3, 1>(3, 6);
  MessageCovariance twist = MessageCovariance::Zero();
  twist.topLeftCorner<3, 3>() =
      target_from_world * motion.covariance.block<3, 3>(3, 3) * target_from_world.transpose();
  twist.diagonal().tail<3>() << kUnknownAngleVariance, kUnknownAngleVariance,
      motion.covariance(6, 6);
  twist.topRightCorner<3, 1>() = with_turn;
  twist.bottomLeftCorner<1, 3>() = with_turn.transpose();

  OdometryMessage message;
  message.header = HeaderOf(target.time, world_frame);
  message.child_frame_id = target_frame;
  message.pose = {PoseMessageOf(world_from_target), NumbersOf(pose)};
  message.twist.twist.linear = MessageOf(target_from_world * motion.velocity());
  message.twist.twist.angular.z = motion.turn_rate();
  message.twist.covariance = NumbersOf(twist);
  return message;
}

PathMessage PredictionOf(const TargetEstimate& target, const TurnNoise& noise, Duration horizon,
                         Duration step, const std::string& world_frame) {
  PathMessage message;
  message.header = HeaderOf(target.time, world_frame);
  for (Duration ahead = Duration::zero(); ahead <= horizon; ahead += step) {
    const TargetEstimate then{target.time + ahead,
                              Propagate(target.motion, ToSeconds(ahead), noise)};
    message.poses.push_back({HeaderOf(then.time, world_frame), PoseMessageOf(PoseOf(then))});
  }
  return message;
}

MarkerArrayMessage MarkersOf(const LandingObservation& observation, const TargetShape& shape,
                             const std::string& camera_frame,
                             const std::optional<std::string>& world_frame) {
  MarkerArrayMessage message;
  message.markers.push_back(PatternMarker(observation, shape, camera_frame));
  if (!world_frame) return message;
  message.markers.push_back(VelocityMarker(observation, *world_frame));
  message.markers.push_back(UncertaintyMarker(observation, *world_frame));
  return message;
}

ImageMessage ImageMessageOf(const cv::Mat& image, Time stamp, const std::string& camera_frame) {
  ImageMessage message;
  message.header = HeaderOf(stamp, camera_frame);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.width = static_cast<std::uint32_t>(image.cols);
  message.encoding = "bgr8";
  message.step = static_cast<std::uint32_t>(image.step);
  message.data = {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
  return message;
}

}  // namespace kestrel
