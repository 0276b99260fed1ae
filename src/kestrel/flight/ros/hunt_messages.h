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

// Results of the pipeline of coloured objects as messages of ROS. Stamps are capture times.

// The located objects of a frame, in the camera's frame: the class by name, its probability as the
// score, the position with its covariance. The orientation is unknown.
Detection3DArrayMessage DetectionsOf(const HuntObservation& observation, const ObjectModel& model,
                                     const std::string& camera_frame);

// For RViz: the objects in the world, in their colours. They replace those of the frame before.
MarkerArrayMessage MarkersOf(const HuntObservation& observation, const ObjectModel& model,
                             const std::string& world_frame);

// The map at 'stamp': each object where it was last seen, with that time in its own header; the
// score is the probability that it exists. An object that fits no class (its colour is still open)
// has a box and no class.
Detection3DArrayMessage MapOf(const std::vector<MappedObject>& objects, Time stamp,
                              const ObjectModel& model, const std::string& world_frame);

// The same for RViz: bodies in their colours, labels, and the path within the next second of those
// that move. They stay until the next map.
MarkerArrayMessage MapMarkersOf(const std::vector<MappedObject>& objects, Time stamp,
                                const ObjectModel& model, const std::string& world_frame);

// The team's map as MapOf and MapMarkersOf. The labels also say which UAVs have an object in their
// map and which one claims it: "red: one two, for two".
Detection3DArrayMessage TeamDetectionsOf(const TeamReport& team, const ObjectModel& model,
                                         const std::string& world_frame);
MarkerArrayMessage TeamMarkersOf(const TeamReport& team, const ObjectModel& model,
                                 const std::string& world_frame);

}  // namespace kestrel
