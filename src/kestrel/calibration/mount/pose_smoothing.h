// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// Returns the samples with less noise. Each is replaced by the value of the parabolas, of position
// and of rotation vector, that fit all samples up to 'half_window' before and after it best
// (Savitzky and Golay 1964, for times that need not be even). There is no delay; motion that is
// fast for the window is flattened. A sample with fewer than five others around it stays as it is.
// 'samples': in order of time.
std::vector<PoseSample> SmoothPoses(const std::vector<PoseSample>& samples, Duration half_window);

}  // namespace kestrel
