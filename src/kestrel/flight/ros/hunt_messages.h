// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/io/bags/result_messages.h"
#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

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

// The map as it was at 'stamp': where each object was when it was last seen, the stamp of its own
// header; the score is the probability that it is there. An object that no class has (its colour is
// still open) has a box and no class.
Detection3DArrayMessage MapOf(const std::vector<MappedObject>& objects, Time stamp,
                              const ObjectModel& model, const std::string& world_frame);

// The same for RViz: bodies in their colours, what they are in words, and where those that move
// drive within a second. They stay until the next map.
MarkerArrayMessage MapMarkersOf(const std::vector<MappedObject>& objects, Time stamp,
                                const ObjectModel& model, const std::string& world_frame);

// The team's map as MapOf and MapMarkersOf; the words also say who has an object in its map and who
// goes for it: "red: one two, for two".
Detection3DArrayMessage TeamDetectionsOf(const TeamReport& team, const ObjectModel& model,
                                         const std::string& world_frame);
MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame);

}  // namespace kestrel
