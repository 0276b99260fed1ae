// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

inline constexpr std::string_view kVideoDevice = "/dev/video";  // and its number

// The frames of a video file, by GStreamer. A frame's name is the file's with the frame's number
// below it: "flight.mp4/000012". Its time is the stream's where it has one that increases, else the
// time of the frame before and one period more. The container's count of frames may be an estimate;
// a video that ends more than 2 frames and 2 % before it is at fault. Throws InputError when the
// file has no video that can be decoded.
std::unique_ptr<FrameSource> OpenVideoFile(const std::string& path);

// The same of a camera, without an end: a device (/dev/video0), an address (rtsp://...) or a
// GStreamer pipeline. Throws InputError when it does not open.
std::unique_ptr<FrameSource> OpenCamera(const std::string& camera);

}  // namespace kestrel
