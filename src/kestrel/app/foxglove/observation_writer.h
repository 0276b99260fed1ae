// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "kestrel/app/foxglove/camera_writer.h"
#include "kestrel/app/foxglove/foxglove_messages.h"
#include "kestrel/app/foxglove/foxglove_sink.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/app/views/task_view.h"
#include "kestrel/app/views/view_data.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/session_event.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Writes frames and their results as messages for Foxglove and other viewers. All messages of a
// frame have the frame's time:
//
//   /camera/image, /camera/calibration   foxglove.CompressedImage (JPEG), CameraCalibration
//   /camera/annotations                  foxglove.ImageAnnotations
//   /camera/pose, /tf                    foxglove.PoseInFrame, FrameTransforms, where it is known
//   /landing/target                      foxglove.PoseInFrame: the track
//   /scene                               foxglove.SceneUpdate
//   /result                              kestrel.FrameResult: covariances and times
//   /log                                 foxglove.Log
//
// All calls throw InputError when the sink cannot be written.
class ObservationWriter {
 public:
  // 'sink' outlives this. 'view': view of a landing or of a hunt.
  ObservationWriter(FoxgloveSink* sink, const CameraIntrinsics& camera, TaskView view);

  // The observation must be of the view's kind. 'latency': from capture to the result, in flight.
  void Write(const Frame& frame, const LandingObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void Write(const Frame& frame, const HuntObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void Write(const Observation& observation);
  void Write(const SessionEvent& event);

 private:
  void WriteCameraPose(Time time, const RigidTransform& world_from_camera);
  void WriteResult(const Frame& frame, std::optional<Duration> latency,
                   foxglove::FrameResult result);

  FoxgloveSink* sink_;
  CameraWriter images_;
  TaskView view_;
  TrackState track_state_ = TrackState::kSearching;
};

}  // namespace kestrel
