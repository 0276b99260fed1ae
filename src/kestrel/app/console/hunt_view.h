// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// What the page shows of a hunt for coloured objects.

// What is the same for all frames.
struct HuntView {
  ObjectModel model;
  ObjectDetectorOptions detector = {};
};

// How many objects are in view, time of the detection: what HuntSample has the values of.
std::vector<SeriesDescription> HuntSeries();
ConsoleSample HuntSample(const HuntObservation& observation);

// The ellipses of the objects; rejected are those whose size says that they are not on the ground.
std::vector<OverlayLayer> HuntLayers();
std::vector<OverlayShape> HuntShapes(const HuntView& view, const HuntObservation& observation);

// "segmentation": SegmentationView.
std::vector<ImageView> HuntImageViews(const HuntView& view);

// How many objects there are, or that there is none and at which tests the segments fell.
ConsoleStatus HuntStatus(const HuntObservation& observation);

// How many objects there are, and which.
std::vector<ConsoleFact> HuntFacts(const HuntView& view, const HuntObservation& observation);

// The camera, as LandingMap, and the objects in view that have a place in the world.
ConsoleMap HuntMap(const HuntView& view, const HuntObservation& observation);

// What the team knows of, by class or, where the model has none, shape.
ConsoleTeam HuntTeam(const HuntView& view, const TeamReport& report);

}  // namespace kestrel
