// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/camera/camera_model.h"
#include "kestrel/console/console_feed.h"
#include "kestrel/landing/landing_pattern.h"
#include "kestrel/pipeline/landing_pipeline.h"
#include "kestrel/tracking/turn_motion.h"

namespace kestrel {

// What the page shows of a landing.

// Height of the camera above the target, horizontal offset from it, speed of the target, quality of
// the detection, time of the detection: what LandingSample has the values of.
std::vector<SeriesDescription> LandingSeries();
ConsoleSample LandingSample(const LandingObservation& observation);

// The outlines of the ring and the centre of the cross where they were found, and two standard
// deviations of where the track says that the centre is. A line ends where the lens does.
std::vector<OverlayShape> LandingShapes(const CameraModel& camera, const LandingPattern& pattern,
                                        const LandingObservation& observation);

// The state of the track, and why the pattern was not found.
ConsoleStatus LandingStatus(const LandingObservation& observation);

// The camera (its heading is that of the image's upper edge), the target, and where it will be in
// 1, 2 and 3 s. 'noise': of the track's motion.
ConsoleMap LandingMap(const LandingObservation& observation, const TurnNoise& noise);

}  // namespace kestrel
