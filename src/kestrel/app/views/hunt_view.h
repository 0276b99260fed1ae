// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/views/view_data.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// The view of a hunt for coloured objects.

// Data that are the same for all frames.
struct HuntView {
  using Seen = HuntObservation;

  ObjectModel model;
  ObjectDetectorOptions detector = {};
};

// Returns the series of HuntSample: number of objects in view, time of the detection.
std::vector<SeriesDescription> HuntSeries();
ViewSample HuntSample(const HuntObservation& observation);

// The ellipses of the objects. Objects whose size contradicts a place on the ground are rejected.
std::vector<OverlayLayer> HuntLayers();
std::vector<OverlayShape> HuntShapes(const HuntView& view, const HuntObservation& observation);

// Returns one view, "segmentation": SegmentationView.
std::vector<ImageView> HuntImageViews(const HuntView& view);

// Returns the number of objects or, when there is none, how many segments each test rejected.
ViewStatus HuntStatus(const HuntObservation& observation);

// Returns the number of objects and their classes.
std::vector<ViewFact> HuntFacts(const HuntView& view, const HuntObservation& observation);

// Returns the camera, as LandingMap does, and the objects in view that have a position in the
// world.
ViewMap HuntMap(const HuntView& view, const HuntObservation& observation);

// Returns the team's objects, labelled by class or, where the model has no such class, by shape.
ViewedTeam HuntTeam(const HuntView& view, const TeamReport& report);

}  // namespace kestrel
