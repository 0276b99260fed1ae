// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/image/small_mask.h"

namespace kestrel {

// Thins the set pixels to lines of one pixel that keep their connections (Guo and Hall, "Parallel
// thinning with two-subiteration algorithms", CACM 32(3), 1989, algorithm A1; paper, section 2.4).
// 'max_iterations': largest number of pairs of sub-iterations, converged or not.
void ThinGuoHall(SmallMask* mask, int max_iterations);

}  // namespace kestrel
