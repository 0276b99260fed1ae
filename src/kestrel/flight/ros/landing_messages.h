// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_detection.h"
#include "kestrel/vision/target/target_shape.h"
#include "kestrel/vision/tracking/target_tracker.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// Results of the landing pipeline as messages of ROS. Stamps are capture times. Frames follow REP
// 103: the camera's is an optical one, the world's z is up.

// The detection in the camera's frame; an empty list when there is none. The box is the board's,
// the score is the detection's quality, the id (ROS 2) the pad's where it has one.
Detection3DArrayMessage DetectionsOf(const LandingObservation& observation,
                                     const std::string& camera_frame, const TargetShape& shape);

// The pose of the pattern in the camera's frame, with its covariance.
PoseWithCovarianceStampedMessage TargetPoseOf(const TargetDetection& detection, Time stamp,
                                              const std::string& camera_frame);

// The same for tf.
TfMessage PatternTransformOf(const TargetDetection& detection, Time stamp,
                             const std::string& camera_frame, const std::string& pattern_frame);

// The track: the target's pose in the world, headed along its velocity; velocities in its own
// frame. Quantities that the track does not know (roll, pitch and their rates) have a variance of
// pi^2 / 3.
OdometryMessage TrackOf(const TargetEstimate& target, const std::string& world_frame,
                        const std::string& target_frame);

// Predicted path of the target, from its own time to 'horizon' ahead in steps of 'step' (above 0),
// when only 'noise' disturbs its motion.
PathMessage PredictionOf(const TargetEstimate& target, const TurnNoise& noise, Duration horizon,
                         Duration step, const std::string& world_frame);

// For RViz: the pad in the camera's frame; in the world's frame, where it is known, the
// target's path within the next second and the ellipsoid of three standard deviations around it.
MarkerArrayMessage MarkersOf(const LandingObservation& observation, const TargetShape& shape,
                             const std::string& camera_frame,
                             const std::optional<std::string>& world_frame);

// The message refers to the pixels of the image (CV_8UC3, BGR, continuous) without a copy.
ImageMessage ImageMessageOf(const cv::Mat& image, Time stamp, const std::string& camera_frame);

}  // namespace kestrel
