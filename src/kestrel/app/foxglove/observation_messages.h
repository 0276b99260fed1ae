// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/console/hunt_view.h"
#include "kestrel/app/console/landing_view.h"
#include "kestrel/app/foxglove/foxglove_messages.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// What a viewer shows of frames and of what was found in them. The world's frame is "map", the
// camera's "camera_optical_frame", the pattern's "landing_pattern".
inline constexpr const char* kFoxgloveWorld = "map";
inline constexpr const char* kFoxgloveCamera = "camera_optical_frame";
inline constexpr const char* kFoxglovePattern = "landing_pattern";

foxglove::CameraCalibration FoxgloveCalibration(Time time, const CameraIntrinsics& camera);

foxglove::FrameTransform FoxgloveTransform(Time time, const char* parent, const char* child,
                                           const RigidTransform& parent_from_child);

foxglove::Pose FoxglovePose(const RigidTransform& pose);

// What the console draws over the image: what was found green, what was rejected red, what is
// expected blue.
foxglove::ImageAnnotations FoxgloveAnnotations(Time time, const std::vector<OverlayShape>& shapes);

// In the world: the target's ring, two standard deviations of its position and its path in the next
// 3 s; of objects in view two standard deviations and what they are. Each for a second.
foxglove::SceneUpdate FoxgloveScene(const LandingView& view, const LandingObservation& observation);
foxglove::SceneUpdate FoxgloveScene(const HuntView& view, const HuntObservation& observation);

// Without the frame's name and the latency.
foxglove::FrameResult FoxgloveResult(const LandingObservation& observation);
foxglove::FrameResult FoxgloveResult(const HuntView& view, const HuntObservation& observation);

}  // namespace kestrel
