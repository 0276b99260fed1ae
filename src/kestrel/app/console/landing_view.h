// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/landing/landing_pattern.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// What the page shows of a landing.

// What is the same for all frames.
struct LandingView {
  CameraModel camera;
  LandingPattern pattern;
  TurnNoise noise;  // of the track's motion
};
LandingView ViewOf(const CameraCalibration& calibration, const LandingPipelineOptions& options);

// Height of the camera above the target, horizontal offset from it, speed of the target, quality of
// the detection, time of the detection: what LandingSample has the values of.
std::vector<SeriesDescription> LandingSeries();
ConsoleSample LandingSample(const LandingObservation& observation);

// The outlines of the ring and the centre of the cross where they were found, rejected where the
// track says that this cannot be, and two standard deviations of where the track has the centre. Of
// a misfit the outlines as seen, and rejected where pose and calibration have them. A line ends
// where the lens does.
std::vector<OverlayLayer> LandingLayers();
std::vector<OverlayShape> LandingShapes(const LandingView& view,
                                        const LandingObservation& observation);

// "threshold 1/8", "1/4", "1/2", "1/1": ThresholdView at these resolutions, the nearest patterns
// first.
std::vector<ImageView> LandingImageViews();

// The state of the track, and why the pattern was not found.
ConsoleStatus LandingStatus(const LandingObservation& observation);

// Whether the pattern was found, or why not; by which method and with which quality; how far pose
// and calibration are beside it.
std::vector<ConsoleFact> LandingFacts(const LandingObservation& observation);

// The camera (its heading is that of the image's upper edge), the target, and where it will be in
// 1, 2 and 3 s.
ConsoleMap LandingMap(const LandingView& view, const LandingObservation& observation);

}  // namespace kestrel
