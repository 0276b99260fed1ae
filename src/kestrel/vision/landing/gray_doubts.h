// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/vision/landing/print_doubts.h"
#include "kestrel/vision/landing/small_pattern.h"

namespace kestrel {

// Logarithm of what a correlation lacks of 1.
double LogLacking(double correlation);

// What the gray values of a print that was fitted as a whole are not.
void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts);

// How little is seen of it: 'diameters_px' of its ring, standard deviation of its position as a
// share of the distance.
void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts);

}  // namespace kestrel
