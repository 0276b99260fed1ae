// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "kestrel/app/evaluation/landing_comparison.h"
#include "kestrel/app/evaluation/report_table.h"

namespace kestrel {

// The paper's Table 2: found of visible by condition and altitude, with Wilson intervals, and
// detections of something else; the last rows are those of images without the pattern.
ReportTable SuccessTable(std::span<const LandingComparison> comparisons);

// Found of all images with some of the pattern in view, by the part that is in view, by the tilt of
// the UAV and by the motion during the exposure. Images of which that is not known are left out.
ReportTable VisibleFractionTable(std::span<const LandingComparison> comparisons);
ReportTable TiltTable(std::span<const LandingComparison> comparisons);
ReportTable MotionTable(std::span<const LandingComparison> comparisons);

// Errors of what was found by altitude: centre, position across and along the line of sight,
// position in the world, yaw.
ReportTable ErrorTable(std::span<const LandingComparison> comparisons);

// Whether the reported standard deviations are right: mean NEES by altitude with its bounds.
ReportTable ConsistencyTable(std::span<const LandingComparison> comparisons);

}  // namespace kestrel
