// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/frame.h"
#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {

// Returns the image of a message in 'format'. Encodings: mono8, 8UC1, bgr8, 8UC3, rgb8, bgra8,
// 8UC4, rgba8, Bayer's patterns (bayer_rggb8, ...), yuv422 (UYVY), yuv422_yuy2 (YUYV), and ROS'
// other names for these. The result owns its pixels. Throws InputError with 'name' for any other
// encoding (16 bits), and when size, step and number of bytes do not fit.
cv::Mat DecodeImage(const ImageMessage& message, PixelFormat format, const std::string& name);

// The same for JPEG and PNG.
cv::Mat DecodeImage(const CompressedImageMessage& message, PixelFormat format,
                    const std::string& name);

}  // namespace kestrel
