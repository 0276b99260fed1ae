// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// A pose from a message of any supported type.
struct StampedPose {
  Time stamp;
  std::string world;                   // frame of the pose
  std::string body;                    // empty if the type does not have it
  std::optional<RigidTransform> pose;  // nothing when it is not valid (TransformOf)
  std::optional<TwistMessage> twist;   // in the body's frame
};

// True when ParsePose supports this type: PoseStamped, PoseWithCovarianceStamped, TransformStamped
// and Odometry.
bool IsPoseType(std::string_view type);

// Parses a message of such a type. Throws InputError with 'name' when it is broken.
StampedPose ParsePose(std::string_view type, std::string_view data, WireFormat format,
                      const std::string& name);

// Returns the motion of the body whose pose in the world is 'pose'. Returns nothing when the twist
// was not filled in, which means that it is zero.
std::optional<BodyMotion> MotionOf(const TwistMessage& twist, const RigidTransform& pose);

}  // namespace kestrel
