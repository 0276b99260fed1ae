// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

inline constexpr std::string_view kVideoDevice = "/dev/video";  // followed by its number

// Opens the frames of a video file by GStreamer. A frame's name is the file's name with the frame's
// number below it: "flight.mp4/000012". Its time is that of the stream if it has one that
// increases, else the time of the frame before plus one period. The number of frames is an
// estimate; the stream's end is the end, but a file that is cut off (VideoContainer) is an error
// there. Throws InputError when the file has no video that can be decoded.
std::unique_ptr<FrameSource> OpenVideoFile(const std::string& path);

// The same for a camera, without an end: a device (/dev/video0), an address (rtsp://...) or a
// GStreamer pipeline. Throws InputError when it cannot be opened.
std::unique_ptr<FrameSource> OpenCamera(const std::string& camera);

}  // namespace kestrel
