// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
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
// frame have the frame's time; with several cameras, on the clock of the first one:
//
//   /camera/image, /camera/calibration   foxglove.CompressedImage (JPEG), CameraCalibration
//   /camera/annotations                  foxglove.ImageAnnotations
//   /camera/pose, /tf                    foxglove.PoseInFrame, FrameTransforms, where it is known
//   /landing/target                      foxglove.PoseInFrame: the track
//   /scene                               foxglove.SceneUpdate
//   /result                              kestrel.FrameResult: covariances and times
//   /log                                 foxglove.Log
//
// The camera after the first one is /cam1 in place of /camera, or as it is called, and so on.
//
// All calls throw InputError when the sink cannot be written.
class ObservationWriter {
 public:
  // 'sink' outlives this. 'view': view of a landing or of a hunt.
  ObservationWriter(FoxgloveSink* sink, const CameraIntrinsics& camera, TaskView view);

  // Adds the camera of the frames with the next index, from 1. 'name': of its topics.
  void AddCamera(const std::string& name, const CameraIntrinsics& camera, TaskView view);

  // The observation must be of the view's kind. 'latency': from capture to the result, in flight.
  void Write(const Frame& frame, const LandingObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void Write(const Frame& frame, const FollowObservation& observation,
             std::optional<Duration> latency);
  void Write(const Frame& frame, const HuntObservation& observation,
             std::optional<Duration> latency = std::nullopt);
  void Write(const Observation& observation);
  void Write(const SessionEvent& event);

 private:
  struct Camera {
    Camera(FoxgloveSink* sink, const CameraIntrinsics& camera, CameraTopics topics,
           TaskView camera_view)
        : images(sink, camera, std::move(topics)), view(std::move(camera_view)) {}

    CameraWriter images;
    TaskView view;
  };

  void WriteCameraPose(const Camera& camera, Time time, const RigidTransform& world_from_camera);
  void WriteResult(const Frame& frame, Time time, std::optional<Duration> latency,
                   foxglove::FrameResult result);

  FoxgloveSink* sink_;
  std::deque<Camera> cameras_;  // they do not move
  TrackState track_state_ = TrackState::kSearching;
};

}  // namespace kestrel
