// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {

// The newest transforms of tf as they come. What /tf_static tells stands still, all else may move.
class LiveTransforms {
 public:
  // A transform that is not valid is left out.
  void Add(const TransformStampedMessage& transform, bool is_static);

  // 'to' from 'from', where all frames between them stand still.
  std::optional<RigidTransform> Fixed(const std::string& to, const std::string& from) const;

  struct WorldPose {
    std::string world;
    PoseSample sample;
  };
  // The pose of 'body' that the transform just added tells, when that is the first above 'body'
  // that moves; in 'world', or in the root of the body's frames where that is empty. Its time is
  // the transform's.
  std::optional<WorldPose> PoseBy(const TransformStampedMessage& transform, const std::string& body,
                                  const std::string& world) const;

 private:
  struct Link {
    std::string parent;
    RigidTransform parent_from_frame;
    bool is_static;
  };
  // 'frame' and all above it with what leads to it from 'frame'; only over frames that stand still
  // where 'only_static' is set.
  struct Ancestor {
    std::string name;
    RigidTransform ancestor_from_frame;
  };
  std::vector<Ancestor> AncestorsOf(const std::string& frame, bool only_static) const;

  std::map<std::string, Link> links_;
};

}  // namespace kestrel
