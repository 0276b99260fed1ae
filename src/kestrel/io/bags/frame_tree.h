// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {

// The rigid transform that a pose of ROS is, or nothing when it is not finite or its quaternion is
// not of unit length (to 1 %).
std::optional<RigidTransform> TransformOf(const PoseMessage& pose);
PoseMessage PoseMessageOf(const RigidTransform& transform);

// A frame's name without the slash that ROS 1 once put before it.
std::string FrameName(const std::string& frame_id);

// The frames of tf: each has a parent, and stands still in it or moves.
class FrameTree {
 public:
  // A transform that is not valid is left out.
  void Add(const TransformStampedMessage& transform);

  bool Has(const std::string& frame) const;

  // 'frame', its parent, and so on to the root; only over frames that stand still in their parent
  // where 'only_fixed' is set.
  std::vector<std::string> ChainToRoot(const std::string& frame, bool only_fixed) const;

  bool IsFixed(const std::string& frame) const;

  // 'to' from 'from', where all frames between them stand still.
  std::optional<RigidTransform> Fixed(const std::string& to, const std::string& from) const;

 private:
  struct Link {
    std::string parent;
    RigidTransform parent_from_frame;  // the first
    bool is_fixed = true;
  };
  std::map<std::string, Link> links_;
};

}  // namespace kestrel
