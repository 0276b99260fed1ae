// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The interface of everything that has frames on disk: folders, videos, bags.
//
// Example:
//   const std::unique_ptr<FrameSource> source = OpenSource({"flight.mp4"});
//   source->set_format(PixelFormat::kBgr);
//   for (Frame frame; source->Next(&frame);) {
//     std::cout << frame.name << " at " << ToNanoseconds(frame.time) << " ns\n";
//   }

#include "kestrel/io/recording/frame_source.h"  // IWYU pragma: export
