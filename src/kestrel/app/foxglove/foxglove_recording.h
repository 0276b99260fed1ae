// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/app/foxglove/camera_writer.h"
#include "kestrel/app/foxglove/foxglove_file.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/io/bags/recording_sink.h"

namespace kestrel {

// Writes a recording as an MCAP file for Foxglove and other viewers: frames (see CameraWriter),
// poses as /pose (foxglove.PoseInFrame) and /tf (foxglove.FrameTransforms, "map" to "base_link"),
// and with each frame the mount as /tf ("base_link" to "camera_optical_frame").
class FoxgloveRecording : public RecordingSink {
 public:
  // The file must not exist unless 'replace' is set; its name ends in .mcap. Throws InputError.
  FoxgloveRecording(const std::string& path, const RecordingHead& head, bool replace);

  void AddPose(const PoseSample& pose) override;
  void AddFrame(const Frame& frame) override;
  void Close() override { file_.Close(); }

 private:
  FoxgloveFile file_;
  CameraWriter camera_;
  std::optional<RigidTransform> body_from_camera_;
};

}  // namespace kestrel
