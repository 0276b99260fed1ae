// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// True when the argument is not a file but a camera (/dev/video0, rtsp://...) or a GStreamer
// pipeline.
bool IsCamera(const std::string& source);

// Opens the source that the arguments name: a recording folder (EuRoC), a folder of images, one or
// more image files, a video file, a camera (/dev/video0) or a GStreamer pipeline. Throws InputError
// with their fault. 'format': pixel format of the frames.
std::unique_ptr<FrameSource> OpenSource(const std::vector<std::string>& arguments,
                                        PixelFormat format = PixelFormat::kGray);

}  // namespace kestrel
