// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/app/evaluation/plot.h"
#include "kestrel/calibration/lens/lens_calibration.h"

namespace kestrel {

// What the lens leaves unexplained of the edges, and how far from the principal point it shows
// directions, both by their angle to the optical axis; beyond the edges the latter is dashed.
Plot LensResidualPlot(const LensCalibration& calibration);

// Where the edges are in the image, of every view a colour.
Plot LensCoveragePlot(const LensCalibration& calibration);

}  // namespace kestrel
