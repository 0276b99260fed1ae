// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/evaluation/plot.h"
#include "kestrel/calibration/lens/lens_calibration.h"

namespace kestrel {

// Returns the residuals of the edges, and the distance from the principal point at which the lens
// shows a direction, both over the angle to the optical axis. Beyond the edges the latter is
// dashed.
Plot LensResidualPlot(const LensCalibration& calibration);

// Returns the positions of the edges in the image, with one colour per view.
Plot LensCoveragePlot(const LensCalibration& calibration);

}  // namespace kestrel
