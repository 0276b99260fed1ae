// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {

// One pose as a message of any of the types tells it.
struct StampedPose {
  Time stamp;
  std::string world;  // the frame that the pose is in
  std::string body;   // empty where the type does not say
  PoseMessage pose;
  std::optional<TwistMessage> twist;  // in the body's frame
};

// Whether ParsePose reads this type: PoseStamped, PoseWithCovarianceStamped, TransformStamped and
// Odometry.
bool IsPoseType(std::string_view type);

// Reads a message of such a type. Throws InputError, with 'name', when it is broken.
StampedPose ParsePose(std::string_view type, std::string_view data, WireFormat format,
                      const std::string& name);

// How the body moves whose pose in the world is 'pose'. Nothing where the twist was not filled in:
// then it is zero.
std::optional<BodyMotion> MotionOf(const TwistMessage& twist, const RigidTransform& pose);

}  // namespace kestrel
