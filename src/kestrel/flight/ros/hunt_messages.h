// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/flight/session/flight_report.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// Results of the pipeline of coloured objects as messages of ROS. Stamps are capture times.

// The located objects of a frame, in the camera's frame: the class by name, its probability as the
// score, the position with its covariance. The orientation is unknown.
Detection3DArrayMessage DetectionsOf(const HuntObservation& observation, const ObjectModel& model,
                                     const std::string& camera_frame);

// For RViz: the objects in the world, in their colours. They replace those of the frame before.
MarkerArrayMessage MarkersOf(const HuntObservation& observation, const ObjectModel& model,
                             const std::string& world_frame);

// The team's map, all of it at one time; the score is the probability that an object exists. An
// object that fits no class (its colour is still open) has a box and no class.
Detection3DArrayMessage TeamDetectionsOf(const TeamReport& team, const ObjectModel& model,
                                         const std::string& world_frame);

// The same for RViz: bodies in their colours, with labels that also name the UAVs that have an
// object in their map and which one claims it: "red: one two, for two". They stay until the next
// map.
MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame);

}  // namespace kestrel
