// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// Returns the rigid transform of a ROS pose; nothing when it is not finite or its quaternion does
// not have unit length (to 1 %).
std::optional<RigidTransform> TransformOf(const PoseMessage& pose);
std::optional<RigidTransform> TransformOf(const TransformMessage& message);
PoseMessage PoseMessageOf(const RigidTransform& transform);
TransformMessage TransformMessageOf(const RigidTransform& transform);

// Returns a frame's name without the leading slash of old ROS 1 versions.
std::string FrameName(const std::string& frame_id);

// The tree of tf frames: each frame has a parent, and is fixed in it or moves.
class FrameTree {
 public:
  // A transform that is not valid is ignored.
  void Add(const TransformStampedMessage& transform);

  bool Has(const std::string& frame) const;

  // Returns 'frame', its parent and so on up to the root; with 'only_fixed' only as long as the
  // frames are fixed in their parents.
  std::vector<std::string> ChainToRoot(const std::string& frame, bool only_fixed) const;

  bool IsFixed(const std::string& frame) const;

  // Returns the transform from 'from' to 'to', if all frames between them are fixed.
  std::optional<RigidTransform> Fixed(const std::string& to, const std::string& from) const;

 private:
  struct Link {
    std::string parent;
    RigidTransform parent_from_frame;  // the first one
    bool is_fixed = true;
  };
  std::map<std::string, Link> links_;
};

}  // namespace kestrel
