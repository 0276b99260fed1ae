// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/io/ros_messages/tag_messages.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_shape.h"

namespace kestrel {

// The tags of a detection as apriltag_ros publishes them, so that its listeners need no change
// (docs/tags.md). Lists are empty when no tag was seen. 'shape' is the detected pad's.

// Each tag that was seen, with its corners in the image that was searched. The homography is that
// of a pinhole camera with the focal lengths and the centre of 'camera': with those it has the
// tag's pose, however wide the lens. The margin is 100 times the quality.
TagArrayMessage TagsOf(const LandingObservation& observation, const CameraModel& camera,
                       const TargetShape& shape, const std::string& camera_frame);

// The frames of the tags that were seen ("tag36h11:0") in the camera's.
TfMessage TagTransformsOf(const LandingObservation& observation, const TargetShape& shape,
                          const std::string& camera_frame);

}  // namespace kestrel
