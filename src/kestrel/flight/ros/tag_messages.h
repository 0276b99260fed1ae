// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/bags/serialization.h"
#include "kestrel/io/bags/tag_messages.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// The tags of a detection as apriltag_ros publishes them, so that its listeners need no change
// (docs/tags.md). Lists are empty when no tag was seen. 'shape' is the detected pad's.

// As the node of ROS 2: each tag that was seen, with its corners in the image that was searched.
// The homography is that of a pinhole camera with the focal lengths and the centre of 'camera':
// with those it has the tag's pose, however wide the lens. The margin is 100 times the quality.
TagArrayMessage TagsOf(const LandingObservation& observation, const CameraModel& camera,
                       const TargetShape& shape, const std::string& camera_frame);

// As the node of ROS 1: the pose of the tag, or that of the bundle with the ids of all its tags.
TagPoseArrayMessage TagPosesOf(const LandingObservation& observation, const TargetShape& shape,
                               const std::string& camera_frame);

// The frames of the tags that were seen in the camera's: "tag36h11:0" in ROS 2; in ROS 1 "tag_0",
// and none for the tags of a bundle, whose frame is that of the pad.
TfMessage TagTransformsOf(const LandingObservation& observation, const TargetShape& shape,
                          const std::string& camera_frame, WireFormat format);

}  // namespace kestrel
