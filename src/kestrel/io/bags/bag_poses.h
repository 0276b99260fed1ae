// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/topic_choice.h"

namespace kestrel {

// The poses of the UAV in a bag, and the mount of the camera.
struct BagPoses {
  std::vector<PoseSample> poses;                   // in order of time, all different
  std::optional<RigidTransform> body_from_camera;  // if tf has it
  std::string remark;                              // what was left out, in one line; else empty
};

// Reads the poses of a bag in one pass, or in two if they are in tf. The body is the child frame of
// the poses, or base_link, or the frame that the camera is fixed to. 'camera_frame': frame of the
// images; empty if they do not name it. 'use_arrival_times': use them instead of the stamps. Throws
// InputError when a message is broken or all stamps are zero.
BagPoses ReadPoses(BagReader* bag, const TopicChoice& topics, const std::string& camera_frame,
                   bool use_arrival_times, const std::string& path);

}  // namespace kestrel
