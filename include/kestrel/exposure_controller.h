// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An exposure control that keeps the white of the pattern below saturation in any light.
//
// Example:
//   ExposureController exposure({.max_exposure_s = 0.004}, /*exposure_s=*/0.001);
//   std::cout << exposure.Update(image) << " s for the following images\n";

#include "kestrel/core/camera/exposure_controller.h"  // IWYU pragma: export
