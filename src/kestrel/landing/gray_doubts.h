// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/landing/pattern_match.h"
#include "kestrel/landing/print_doubts.h"
#include "kestrel/landing/small_pattern.h"

namespace kestrel {

// What the parts of a print lack: arms, white quadrants, ring.
void DoubtParts(const PatternMatch& match, PrintDoubts* doubts);

// What the gray values of a print are not, and what other signs have of it.
void DoubtGrayValues(const SmallPatternFitter::Fit& fit, PrintDoubts* doubts);

// How little is seen of it: 'diameters_px' of its ring, standard deviation of its position as a
// share of the distance.
void DoubtView(const Eigen::Vector2d& diameters_px, double relative_sigma, PrintDoubts* doubts);

}  // namespace kestrel
