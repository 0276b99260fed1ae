// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// The paper's Table 2: share of the visible patterns that were found, by condition and altitude,
// with Wilson intervals, and number of false detections. The last rows are for images without the
// pattern.
ReportTable SuccessTable(std::span<const LandingComparison> comparisons);

// Share found of all images with a part of the pattern in view, by the visible fraction, the tilt
// of the UAV and the motion during the exposure. Images for which the quantity is unknown are left
// out.
ReportTable VisibleFractionTable(std::span<const LandingComparison> comparisons);
ReportTable TiltTable(std::span<const LandingComparison> comparisons);
ReportTable MotionTable(std::span<const LandingComparison> comparisons);

// Errors of the right detections by altitude: centre, position across and along the line of sight,
// position in the world, yaw.
ReportTable ErrorTable(std::span<const LandingComparison> comparisons);

// Mean NEES by altitude with its bounds: it shows whether the reported standard deviations are
// right.
ReportTable ConsistencyTable(std::span<const LandingComparison> comparisons);

}  // namespace kestrel
