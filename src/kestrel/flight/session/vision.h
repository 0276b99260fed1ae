// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/core/poses/zoom_history.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/result_files.h"
#include "kestrel/flight/session/track_snapshot.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/pipeline/sought_object.h"

namespace kestrel {

struct TaskOptions;

// Returns the image of an observation with the results drawn in, as CV_8UC3 (BGR).
using ObservationPainter = std::function<cv::Mat(const Observation&)>;

// The vision of a session: a pipeline, or its earlier results. Called by one thread at a time.
class Vision {
 public:
  virtual ~Vision() = default;

  virtual void AddPose(const PoseSample& pose) = 0;
  // Takes a report of the gimbal on which the camera is.
  virtual void AddGimbal(const GimbalSample& sample) = 0;
  // Takes a report of the camera's zoom. Only the landing task sees through a lens that changes.
  virtual void AddZoom(const ZoomSample& /*sample*/) {}

  // Returns how long after a frame's time, on the clock of the navigation, the newest pose may lie
  // that the frame needs: it is processed once poses reach that far.
  virtual Duration pose_lead() const = 0;

  // Throws InputError when the frame is none of those that this has results of. Does not throw in
  // flight.
  virtual Observation Process(const Frame& frame) = 0;

  // What is known of the target after the last frame; only in flight.
  virtual TrackSnapshot snapshot() const { return {}; }
  // The pad that the UAV can land on; nothing: there is none.
  virtual std::optional<PadInSight> pad() const { return std::nullopt; }
  // Options of the track of what a person marks; nothing: this task follows nothing.
  virtual std::optional<TargetTrackerOptions> marked() const { return std::nullopt; }
  // True when it seeks an object for the UAV to go to.
  virtual bool seeks_object() const { return false; }
  // Seeks from now on what is assigned, or not any more the object of this number.
  virtual void Assign(const AssignedObject& /*object*/) {}
  virtual void Leave(int /*number*/) {}
  // The map of the objects; null: none. Changes with the next frame.
  virtual const ObjectMap* map() const { return nullptr; }
  // True when results have places in the world, which are kept from frame to frame.
  virtual bool has_world() const { return false; }

  // Counts the height of the ground in the options from this height in the world (m), instead of
  // from 0.
  virtual void SetGroundZero(double /*height_m*/) {}

  // Continues with other options and another altitude. Track and map stay. Throws InputError and
  // changes nothing when the options are not valid.
  virtual void Change(const TaskOptions& /*options*/, std::optional<double> /*altitude_m*/) {}

  // True when this task follows what a person marks.
  virtual bool takes_marks() const { return false; }
  // Follows from now on what a person has marked in the frame that was the newest one at this time.
  // Throws InputError when that frame is not kept any more, or this task follows nothing.
  virtual void Mark(Time /*frame*/, const cv::Rect2d& /*box_px*/) {
    throw InputError("this task follows nothing that is marked");
  }
  // Follows nothing until the next mark.
  virtual void Unmark() {}

  // Called after the source's last frame. Throws InputError when there are results of more frames.
  virtual void Finish() {}

  // Returns a sink that writes the tables of this vision's results, which it must not outlive;
  // null: there are none. Its functions throw InputError when they cannot write.
  virtual std::unique_ptr<ObservationSink> MakeTables(const OutputOptions& /*output*/) const {
    return nullptr;
  }

  // Returns what draws the observations of the first camera. It may outlive this, and be called by
  // another thread. Usually nothing is drawn.
  virtual ObservationPainter MakePainter() const {
    return [](const Observation& observation) {
      return observation.frame.color.empty() ? observation.frame.image.clone()
                                             : observation.frame.color.clone();
    };
  }

  // Reports which part of the set-up contradicts the images, and what to do, as far as it is known
  // by now; empty where nothing does.
  virtual std::string Warning() const { return ""; }

  // What happened to each of several cameras so far, in words; only grows.
  virtual std::span<const std::string> camera_events() const { return {}; }

  // The summary: Found() for its line ("pattern found in 12"), Remarks() for the lines below it.
  virtual std::string Found() const = 0;
  virtual std::string Remarks() const { return ""; }
};

}  // namespace kestrel
