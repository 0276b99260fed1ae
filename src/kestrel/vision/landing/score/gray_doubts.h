// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/vision/landing/score/print_doubts.h"
#include "kestrel/vision/landing/small_pattern/small_pattern.h"

namespace kestrel {

// Returns the natural logarithm of a share of something, bounded from below.
double LogShare(double share);

// Sets the doubts of a print that was fitted as a whole, by its gray values.
void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts);

// Sets the doubts by the view: size and axis ratio of the ring, 'diameters_px' with the longer axis
// first, and 'relative_sigma', the standard deviation of the position as a share of the distance.
void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts);

}  // namespace kestrel
