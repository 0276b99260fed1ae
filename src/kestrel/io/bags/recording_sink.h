// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/io/bags/decompression.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Writes a new recording: images, poses and the calibration of the camera. All functions throw
// InputError when it cannot be written.
class RecordingSink {
 public:
  virtual ~RecordingSink() = default;

  // Poses and frames must each be in order of time. A frame is BGR; it is written as gray when its
  // channels are equal.
  virtual void AddPose(const PoseSample& pose) = 0;
  virtual void AddFrame(const Frame& frame) = 0;
  // Reports of the gimbal and of the zoom have a place in folders only.
  virtual void AddGimbal(const std::vector<GimbalSample>& /*reports*/) {}
  virtual void AddZoom(const std::vector<ZoomSample>& /*reports*/) {}

  // Completes the recording; nothing can be written after it.
  virtual void Close() = 0;
};

// Description of a new recording.
struct RecordingHead {
  std::optional<CameraCalibration> calibration;
  double rate_hz = 0;  // frame rate of the images
  bool has_poses = false;
  bool has_motion = false;  // the poses have velocities and angular rates
};

// Returns a sink for a recording at 'path': a bag if it ends in .bag, .mcap or .db3, else a folder
// in the EuRoC layout. In a bag the images are /camera/image_raw with camera_info beside them, the
// poses /pose (PoseStamped), or /odom (Odometry) if they have motion, and the mount a static
// transform from base_link to camera_optical_frame. Nothing is replaced unless 'replace' is set.
std::unique_ptr<RecordingSink> NewRecording(const std::string& path, const RecordingHead& head,
                                            Compression compression, bool replace);

}  // namespace kestrel
