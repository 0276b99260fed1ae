// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/app/views/view_data.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/target/target_shape.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// The view of a landing.

// Data that are the same for all frames.
struct LandingView {
  using Seen = LandingObservation;

  CameraModel camera;
  TargetShape shape;
  TurnNoise noise;  // noise of the track's motion
};
LandingView ViewOf(const CameraCalibration& calibration, const LandingPipelineOptions& options);

// Returns the series of LandingSample: height of the camera above the target, horizontal offset
// from it, speed of the target, quality of the detection, time of the detection.
std::vector<SeriesDescription> LandingSeries();
ViewSample LandingSample(const LandingObservation& observation);

// Returns the outlines of the pad and its centre where they were found (layer kRejected if the
// detection is far from the track), and the track's centre as an ellipse of two
// standard deviations. For a misfit: the outlines as seen, and as kRejected those that pose and
// calibration predict. A line ends where the lens model does.
std::vector<OverlayLayer> LandingLayers();
std::vector<OverlayShape> LandingShapes(const LandingView& view,
                                        const LandingObservation& observation);

// Returns the views "threshold 1/8", "1/4", "1/2", "1/1": ThresholdView at these resolutions, the
// nearest patterns first.
std::vector<ImageView> LandingImageViews();

// Returns the state of the track, and why the pattern was not found.
ViewStatus LandingStatus(const LandingObservation& observation);

// Lists whether the pattern was found or why not, the method, the quality, and by how many pixels
// pose and calibration miss it.
std::vector<ViewFact> LandingFacts(const LandingObservation& observation);

// Returns the camera (its heading is that of the image's upper edge), the target, and its predicted
// positions in 1, 2 and 3 s.
ViewMap LandingMap(const LandingView& view, const LandingObservation& observation);

}  // namespace kestrel
