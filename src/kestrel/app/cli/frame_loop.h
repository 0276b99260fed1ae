// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Calls 'process' for each frame of a source until its end or Ctrl-C, and shows a progress bar.
// Throws InputError when the source does, or when a frame does not have the calibration's size.
void ForEachFrame(FrameSource* source, const CameraIntrinsics& intrinsics,
                  const std::function<void(const Frame&)>& process);

}  // namespace kestrel
