// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <ceres/ceres.h>

namespace kestrel {

// Keeps some of the parameters of a block at their values: those whose indices are 'held', of
// 'size'. Not all of them: SetParameterBlockConstant() does that.
inline void HoldParameters(ceres::Problem* problem, double* block, int size,
                           const std::vector<int>& held) {
#if CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR == 0
  problem->SetParameterization(block, new ceres::SubsetParameterization(size, held));
#else
  problem->SetManifold(block, new ceres::SubsetManifold(size, held));
#endif
}

}  // namespace kestrel
