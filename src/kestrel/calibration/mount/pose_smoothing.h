// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/pose_history.h"

namespace kestrel {

// The samples with less noise: each is replaced by the parabolas, of position and of rotation
// vector, that fit all samples up to 'half_window' before and after it best (Savitzky and Golay
// 1964, for times that need not be even). Nothing is delayed; motion that the window is too long
// for is flattened. A sample with fewer than five around it stays as it is. 'samples': in order of
// time.
std::vector<PoseSample> SmoothPoses(const std::vector<PoseSample>& samples, Duration half_window);

}  // namespace kestrel
