// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/bags/result_messages.h"
#include "kestrel/objects/object_model.h"
#include "kestrel/onboard/flight_observer.h"
#include "kestrel/pipeline/hunt_pipeline.h"

namespace kestrel {

// What the pipeline of coloured objects says, in the messages of ROS. Stamps are capture times.

// The objects of a frame that have a location, in the camera's frame: their class by name, its
// probability as the score, the position with its covariance; of how they are turned nothing is
// known.
Detection3DArrayMessage DetectionsOf(const HuntObservation& observation, const ObjectModel& model,
                                     const std::string& camera_frame);

// For RViz: where they are in the world, in their colours; those of the frame before go.
MarkerArrayMessage MarkersOf(const HuntObservation& observation, const ObjectModel& model,
                             const std::string& world_frame);

// The team's map, of the objects that the model has a class for: their class by name, how sure it
// is that they are there as the score, the position with its covariance.
Detection3DArrayMessage TeamDetectionsOf(const TeamReport& team, const ObjectModel& model,
                                         const std::string& world_frame);

// The same for RViz, with the names of those that have each object in their maps and of the one
// that goes for it: "red: one two, for two".
MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame);

}  // namespace kestrel
