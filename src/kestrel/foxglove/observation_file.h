// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kestrel/base/time.h"
#include "kestrel/camera/camera_model.h"
#include "kestrel/console/console_feed.h"
#include "kestrel/console/hunt_view.h"
#include "kestrel/console/landing_view.h"
#include "kestrel/foxglove/camera_writer.h"
#include "kestrel/foxglove/foxglove_file.h"
#include "kestrel/foxglove/foxglove_messages.h"
#include "kestrel/geometry/rigid_transform.h"
#include "kestrel/pipeline/hunt_pipeline.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/recording/frame.h"

namespace kestrel {

// Frames and what a pipeline makes of them, as an MCAP file for Foxglove and other viewers. Every
// message of a frame has the frame's time:
//
//   /camera/image, /camera/calibration   foxglove.CompressedImage (JPEG), CameraCalibration
//   /camera/annotations                  foxglove.ImageAnnotations
//   /camera/pose, /tf                    foxglove.PoseInFrame, FrameTransforms, where it is known
//   /landing/target                      foxglove.PoseInFrame: the track
//   /scene                               foxglove.SceneUpdate
//   /result                              kestrel.FrameResult: covariances and times
//   /log                                 foxglove.Log
//
// All calls throw InputError when it cannot be written.
class ObservationFile {
 public:
  // 'view': what is looked for. The file must not be there unless 'replace' is set.
  ObservationFile(const std::string& path, bool replace, const CameraIntrinsics& camera,
                  std::variant<LandingView, HuntView> view);
  // What was written stays, as after Close; a file without a message is removed.
  ~ObservationFile();
  ObservationFile(const ObservationFile&) = delete;
  ObservationFile& operator=(const ObservationFile&) = delete;

  // The observation must be of what the view is of. 'latency': from capture to the result, live.
  void Write(const Frame& frame, const LandingObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void Write(const Frame& frame, const HuntObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void WriteLog(Time time, EventLevel level, const std::string& text);

  // Writes what waits for more of its second.
  void Flush() { file_.Flush(); }

  // Nothing is written after it.
  void Close();

 private:
  void WriteCameraPose(Time time, const RigidTransform& world_from_camera);
  void WriteResult(const Frame& frame, std::optional<Duration> latency,
                   foxglove::FrameResult result);

  std::string path_;
  FoxgloveFile file_;
  CameraWriter images_;
  std::variant<LandingView, HuntView> view_;
  bool has_messages_ = false;
  bool is_closed_ = false;
  TrackState track_state_ = TrackState::kSearching;
};

}  // namespace kestrel
