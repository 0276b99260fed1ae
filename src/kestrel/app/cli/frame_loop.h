// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/io/recording/event_source.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Calls 'process' for each frame of a source until its end or Ctrl-C, and shows a progress bar.
// Throws InputError when the source does, or when a frame does not have the calibration's size.
void ForEachFrame(FrameSource* source, const CameraIntrinsics& intrinsics,
                  const std::function<void(const Frame&, const ProgressBar&)>& process);

// The same for a stream of poses and frames. 'frame_count': number of frames, if known.
void ForEachEvent(EventSource* source, std::optional<std::size_t> frame_count,
                  const CameraIntrinsics& intrinsics,
                  const std::function<void(const PoseSample&)>& add_pose,
                  const std::function<void(const Frame&, const ProgressBar&)>& process);

}  // namespace kestrel
