// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/bags/decompression.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A new recording: images, poses and the camera's calibration. All calls throw InputError when it
// cannot be written.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;

  // Each in order of time. A frame is BGR; one whose channels are the same is written as gray.
  virtual void AddPose(const PoseSample& pose) = 0;
  virtual void AddFrame(const Frame& frame) = 0;

  // Nothing is written after it.
  virtual void Close() = 0;
};

// What a new recording is to have.
struct RecordingHead {
  std::optional<CameraCalibration> calibration;
  double rate_hz = 0;  // of the images
  bool has_poses = false;
  bool has_motion = false;  // velocity and angular rates in the poses
};

// A recording at 'path': a bag where that ends in .bag, .mcap or .db3, else a folder in the EuRoC
// layout. In a bag the images are /camera/image_raw, with camera_info beside them; the poses /pose
// (PoseStamped), or /odom (Odometry) with their motion; the mount a static transform from base_link
// to camera_optical_frame. Nothing is replaced unless 'replace' is set.
std::unique_ptr<RecordingSink> NewRecording(const std::string& path, const RecordingHead& head,
                                            Compression compression, bool replace);

}  // namespace kestrel
