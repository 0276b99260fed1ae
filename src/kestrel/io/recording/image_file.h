// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/io/recording/frame.h"

namespace kestrel {

// The image in 'format'; colour is converted to luminance by BT.601. The pixels stay where the
// sensor had them: a rotation asked for by EXIF is ignored, because the calibration does not know
// of it. Throws InputError when the file is missing, cut off or not an image, or has other than 8
// bits a channel.
cv::Mat ReadImage(const std::string& path, PixelFormat format);
inline cv::Mat ReadGrayImage(const std::string& path) {
  return ReadImage(path, PixelFormat::kGray);
}

// The same from the bytes of such a file; 'name' is for the message.
cv::Mat DecodeImageBytes(std::string_view bytes, PixelFormat format, const std::string& name);

// 'image' in 'format', as above; 'name' is for the message.
cv::Mat ToFormat(const cv::Mat& image, PixelFormat format, const std::string& name);

}  // namespace kestrel
