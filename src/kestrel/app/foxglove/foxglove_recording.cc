// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/foxglove_recording.h"

#include <filesystem>

#include "kestrel/app/foxglove/foxglove_topics.h"
#include "kestrel/app/foxglove/observation_messages.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr const char* kBody = "base_link";

const std::string& RequireMcap(const std::string& path) {
  if (std::filesystem::path(path).extension() == ".mcap") return path;
  throw InputError(path + ": expected a name that ends in .mcap for Foxglove's messages");
}

std::optional<CameraIntrinsics> IntrinsicsOf(const RecordingHead& head) {
  if (!head.calibration) return std::nullopt;
  return head.calibration->intrinsics;
}

}  // namespace

FoxgloveRecording::FoxgloveRecording(const std::string& path, const RecordingHead& head,
                                     bool replace)
    : file_(RequireMcap(path), replace), camera_(&file_, IntrinsicsOf(head)) {
  if (head.calibration && !head.calibration->gimbal)
    body_from_camera_ = head.calibration->body_from_camera;
}

void FoxgloveRecording::AddPose(const PoseSample& pose) {
  file_.Write(kBodyPoseTopic, pose.time,
              foxglove::PoseInFrame{pose.time, kFoxgloveWorld, FoxglovePose(pose.world_from_body)});
  file_.Write(kTransformsTopic, pose.time,
              foxglove::FrameTransforms{
                  {FoxgloveTransform(pose.time, kFoxgloveWorld, kBody, pose.world_from_body)}});
}

void FoxgloveRecording::AddFrame(const Frame& frame) {
  camera_.Write(frame, frame.time);
  if (!body_from_camera_) return;
  file_.Write(kTransformsTopic, frame.time,
              foxglove::FrameTransforms{
                  {FoxgloveTransform(frame.time, kBody, kFoxgloveCamera, *body_from_camera_)}});
}

}  // namespace kestrel
