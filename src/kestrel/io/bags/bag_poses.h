// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/bag_topics.h"
#include "kestrel/io/bags/frame_tree.h"

namespace kestrel {

// Where the UAV was by a bag, and where the camera sits on it.
struct BagPoses {
  std::vector<PoseSample> poses;                   // in order of time, no two of one
  std::optional<RigidTransform> body_from_camera;  // where tf tells
  std::string remark;                              // what was left out, on one line; else empty
};

// Reads the poses of a bag in one pass, in two where tf has them. The body is the child frame of
// the poses, or base_link, or the frame that the camera is fixed to. 'camera_frame': that of the
// images, empty where they tell none. 'use_arrival_times': instead of the stamps. Throws InputError
// when a message is broken, or all stamps are zero.
BagPoses ReadPoses(BagReader* bag, const BagTopics& topics, const std::string& camera_frame,
                   bool use_arrival_times, const std::string& path);

}  // namespace kestrel
