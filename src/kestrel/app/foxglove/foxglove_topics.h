// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "kestrel/app/foxglove/foxglove_messages.h"
#include "kestrel/app/foxglove/foxglove_sink.h"

namespace kestrel {

inline constexpr FoxgloveTopic<foxglove::CompressedImage> kImageTopic{"/camera/image"};
inline constexpr FoxgloveTopic<foxglove::CameraCalibration> kCalibrationTopic{
    "/camera/calibration"};
inline constexpr FoxgloveTopic<foxglove::ImageAnnotations> kAnnotationsTopic{"/camera/annotations"};
inline constexpr FoxgloveTopic<foxglove::PoseInFrame> kCameraPoseTopic{"/camera/pose"};
inline constexpr FoxgloveTopic<foxglove::PoseInFrame> kBodyPoseTopic{"/pose"};
inline constexpr FoxgloveTopic<foxglove::FrameTransforms> kTransformsTopic{"/tf"};
inline constexpr FoxgloveTopic<foxglove::PoseInFrame> kTargetTopic{"/landing/target"};
inline constexpr FoxgloveTopic<foxglove::SceneUpdate> kSceneTopic{"/scene"};
inline constexpr FoxgloveTopic<foxglove::FrameResult> kResultTopic{"/result"};
inline constexpr FoxgloveTopic<foxglove::Log> kLogTopic{"/log"};

// The names of one camera's topics and of its frame: "/camera/image", "camera_optical_frame".
struct CameraTopics {
  explicit CameraTopics(const std::string& camera = "camera")
      : image("/" + camera + "/image"),
        calibration("/" + camera + "/calibration"),
        annotations("/" + camera + "/annotations"),
        pose("/" + camera + "/pose"),
        frame(camera + "_optical_frame") {}

  std::string image, calibration, annotations, pose, frame;
};

// Topics of frames and of their results; a hunt has no target.
inline constexpr std::array kObservationTopics = {
    InfoOf(kImageTopic),      InfoOf(kCalibrationTopic), InfoOf(kAnnotationsTopic),
    InfoOf(kCameraPoseTopic), InfoOf(kTransformsTopic),  InfoOf(kTargetTopic),
    InfoOf(kSceneTopic),      InfoOf(kResultTopic),      InfoOf(kLogTopic)};

}  // namespace kestrel
