// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Whether the argument is no file: a camera (/dev/video0, rtsp://...) or a GStreamer pipeline.
bool IsCamera(const std::string& source);

// The source that the arguments are: a recording folder (EuRoC), a folder of images, one or more
// image files, a video file, a camera (/dev/video0) or a GStreamer pipeline. Throws InputError that
// says what is wrong with them. 'format': of the frames.
std::unique_ptr<FrameSource> OpenSource(const std::vector<std::string>& arguments,
                                        PixelFormat format = PixelFormat::kGray);

}  // namespace kestrel
