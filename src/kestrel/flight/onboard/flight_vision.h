// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A pipeline in flight. The vision thread calls AddPose and Process, the output thread the rest, so
// that the vision never waits for a disk.
class FlightVision {
 public:
  virtual ~FlightVision() = default;

  virtual void AddPose(const PoseSample& pose) = 0;

  // Sets the height of the camera above the target or the ground where there are no poses; nothing:
  // it is not known.
  virtual void SetAltitude(std::optional<double> altitude_m) = 0;

  // Time from a frame's time, on the navigation's clock, to the last pose that the frame needs.
  virtual Duration pose_lead() const = 0;

  // Processes a frame. 'sink' receives the results; null: there is none.
  virtual TrackSnapshot Process(const Frame& frame, ObservationSink* sink) = 0;

  // Says which part of the set-up contradicts the images, and what to do, as far as it is known by
  // now; empty where nothing does. Called by the vision thread, or after the flight.
  virtual std::string Warning() const { return ""; }

  // Writes the rows of the frames processed since the last call; false when the disk does not take
  // them any more (they are then lost, and the user is told so).
  virtual bool WriteResults() = 0;

  // Returns what was found, for the summary at the end.
  virtual std::string Found() const = 0;
};

}  // namespace kestrel
