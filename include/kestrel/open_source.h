// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A source of frames by its name: a recording, images, a video, a camera.
//
// Example:
//   const auto source = OpenSource({"first.png", "second.png"}, PixelFormat::kGray);
//   const auto calibration = source->calibration();  // nothing: images have none
//   for (Frame frame; source->Next(&frame);) std::cout << frame.name << "\n";

#include "kestrel/io/recording/open_source.h"  // IWYU pragma: export
