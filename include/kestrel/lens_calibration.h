// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The calibration of a lens from views of the landing pattern.
//
// Example:
//   std::vector<LensImage> images;
//   const auto source = OpenSource({"views/"});
//   for (Frame frame; source->Next(&frame);) images.push_back({frame.name, frame.image.clone()});
//   const LensCalibration lens = CalibrateLens(images, {});
//   std::cout << lens.intrinsics.fx_px << " px, " << lens.fit.RootMeanSquare() << " px left\n";

#include "kestrel/calibration/lens/lens_calibration.h"  // IWYU pragma: export
