// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/onboard/target_reporter.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// A pipeline in flight. AddPose and Process are the vision thread's, the rest the output thread's:
// what waits for a disk is not done where the vision would wait for it.
class FlightVision {
 public:
  virtual ~FlightVision() = default;

  virtual void AddPose(const PoseSample& pose) = 0;

  // How much later than a frame's time, on the navigation's clock, the last pose is that it needs.
  virtual Duration pose_lead() const = 0;

  // 'sink': gets what the frame showed; null: there is none.
  virtual TrackSnapshot Process(const Frame& frame, ObservationSink* sink) = 0;

  // What of the set-up contradicts what was seen, and what to do, as far as it is known by now;
  // empty where nothing does. By the vision's thread, or after the flight.
  virtual std::string Warning() const { return ""; }

  // Writes the rows of the frames that were processed meanwhile; false when the disk does not take
  // them any more (then they are lost, and said to be).
  virtual bool WriteResults() = 0;

  // What was found, for the line at the end.
  virtual std::string Found() const = 0;
};

}  // namespace kestrel
