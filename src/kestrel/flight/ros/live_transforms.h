// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// The newest transforms of tf. Those from /tf_static are fixed, all others may move.
class LiveTransforms {
 public:
  // Leaves out a transform that is not valid.
  void Add(const TransformStampedMessage& transform, bool is_static);

  // Returns 'to' from 'from', where all frames between them are fixed to each other; else nothing.
  std::optional<RigidTransform> Fixed(const std::string& to, const std::string& from) const;

  struct WorldPose {
    std::string world;
    PoseSample sample;
  };
  // Returns the pose of 'body' in the root of its frames, if the transform just added is the first
  // above 'body' that moves. Its time is the transform's.
  std::optional<WorldPose> PoseBy(const TransformStampedMessage& transform,
                                  const std::string& body) const;

 private:
  struct Link {
    std::string parent;
    RigidTransform parent_from_frame;
    bool is_static;
  };
  // Returns 'frame' and all frames above it, each with the transform to it from 'frame'.
  // 'only_static': stops at the first link that may move.
  struct Ancestor {
    std::string name;
    RigidTransform ancestor_from_frame;
  };
  std::vector<Ancestor> AncestorsOf(const std::string& frame, bool only_static) const;

  std::map<std::string, Link> links_;
};

}  // namespace kestrel
