// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/session/observation.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// The vision of a session over a recording: a pipeline, or its earlier results. Called by one
// thread.
class Vision {
 public:
  virtual ~Vision() = default;

  virtual void AddPose(const PoseSample& pose) = 0;

  // Time from a frame's time, on the navigation's clock, to the last pose that the frame needs.
  virtual Duration pose_lead() const = 0;

  // Throws InputError when the frame is none of those that this has results of.
  virtual Observation Process(const Frame& frame) = 0;

  // Called after the source's last frame. Throws InputError when there are results of more frames.
  virtual void Finish() {}

  // Says which part of the set-up contradicts the images, and what to do, as far as it is known by
  // now; empty where nothing does.
  virtual std::string Warning() const { return ""; }

  // The summary: Found() for its line ("pattern found in 12"), Remarks() for the lines below it.
  virtual std::string Found() const = 0;
  virtual std::string Remarks() const { return ""; }
};

}  // namespace kestrel
