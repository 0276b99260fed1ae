// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/foxglove/foxglove_messages.h"
#include "kestrel/app/views/follow_view.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Messages that show frames and their results in a viewer. The world's frame is "map", the camera's
// "camera_optical_frame", the pattern's "landing_pattern".
inline constexpr const char* kFoxgloveWorld = "map";
inline constexpr const char* kFoxgloveCamera = "camera_optical_frame";
inline constexpr const char* kFoxglovePattern = "landing_pattern";

foxglove::CameraCalibration FoxgloveCalibration(Time time, const CameraIntrinsics& camera);

foxglove::FrameTransform FoxgloveTransform(Time time, const char* parent, const char* child,
                                           const RigidTransform& parent_from_child);

foxglove::Pose FoxglovePose(const RigidTransform& pose);

// Returns the shapes that the console draws over the image: detections green, rejected ones red,
// predictions blue.
foxglove::ImageAnnotations FoxgloveAnnotations(Time time, const std::vector<OverlayShape>& shapes);

// Returns a scene in the world. For a landing: the target's ring, its position with two standard
// deviations, and its path over the next 3 s. For a hunt: each object in view with its class and
// two standard deviations. For what is followed: its position and its path. Entities last for a
// second.
foxglove::SceneUpdate FoxgloveScene(const LandingView& view, const LandingObservation& observation);
foxglove::SceneUpdate FoxgloveScene(const HuntView& view, const HuntObservation& observation);
foxglove::SceneUpdate FoxgloveScene(const FollowView& view, const FollowObservation& observation);

// The frame's name and the latency are left empty.
foxglove::FrameResult FoxgloveResult(const LandingObservation& observation);
foxglove::FrameResult FoxgloveResult(const HuntView& view, const HuntObservation& observation);
foxglove::FrameResult FoxgloveResult(const FollowObservation& observation);

}  // namespace kestrel
