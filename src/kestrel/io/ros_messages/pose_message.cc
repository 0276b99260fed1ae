// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/pose_message.h"

#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

Eigen::Vector3d VectorOf(const Vector3Message& message) {
  return {message.x, message.y, message.z};
}

}  // namespace

bool IsPoseType(std::string_view type) {
  return type == PoseStampedMessage::kType || type == PoseWithCovarianceStampedMessage::kType ||
         type == TransformStampedMessage::kType || type == OdometryMessage::kType;
}

StampedPose ParsePose(std::string_view type, std::string_view data, WireFormat format,
                      const std::string& name) {
  if (type == PoseStampedMessage::kType) {
    const auto message = ParseMessage<PoseStampedMessage>(data, format, name);
    return {message.header.stamp, message.header.frame_id, "", TransformOf(message.pose),
            std::nullopt};
  }
  if (type == PoseWithCovarianceStampedMessage::kType) {
    const auto message = ParseMessage<PoseWithCovarianceStampedMessage>(data, format, name);
    return {message.header.stamp, message.header.frame_id, "", TransformOf(message.pose.pose),
            std::nullopt};
  }
  if (type == TransformStampedMessage::kType) {
    const auto message = ParseMessage<TransformStampedMessage>(data, format, name);
    return {message.header.stamp, message.header.frame_id, message.child_frame_id,
            TransformOf(message.transform), std::nullopt};
  }
  const auto message = ParseMessage<OdometryMessage>(data, format, name);
  return {message.header.stamp, message.header.frame_id, message.child_frame_id,
          TransformOf(message.pose.pose), message.twist.twist};
}

std::optional<BodyMotion> MotionOf(const TwistMessage& twist, const RigidTransform& pose) {
  const Eigen::Vector3d velocity = VectorOf(twist.linear);
  const Eigen::Vector3d rate = VectorOf(twist.angular);
  if (!velocity.allFinite() || !rate.allFinite()) return std::nullopt;
  if (velocity.isZero(0) && rate.isZero(0)) return std::nullopt;
  return BodyMotion{pose.rotation * velocity, rate};
}

}  // namespace kestrel
