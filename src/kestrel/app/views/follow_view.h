// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/views/view_data.h"
#include "kestrel/vision/pipeline/follow_pipeline.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// The view of something that a person has marked, and that is followed.

// Data that are the same for all frames.
struct FollowView {
  using Seen = FollowObservation;

  TurnNoise noise;  // how fast the track may turn
};

// Returns the series of FollowSample: probability, distance, speed, time of the tracker.
std::vector<SeriesDescription> FollowSeries();
ViewSample FollowSample(const FollowObservation& observation);

// The box: detected while it is seen, predicted while it is not; none once it is lost.
std::vector<OverlayLayer> FollowLayers();
std::vector<OverlayShape> FollowShapes(const FollowObservation& observation);

// Returns the state of the region, and why its place is not known.
ViewStatus FollowStatus(const FollowObservation& observation);

// Returns the size of the box and the place on the ground.
std::vector<ViewFact> FollowFacts(const FollowObservation& observation);

// Returns the camera, as LandingMap does, and the track.
ViewMap FollowMap(const FollowObservation& observation);

}  // namespace kestrel
